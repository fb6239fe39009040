#pragma once

// Lanes (lanes.hpp) for the instructions that the whole build may use.

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define GCPDDA_INSTRUCTIONS widest
#define GCPDDA_NUM_LANES 8
#elif defined(__AVX__)
#define GCPDDA_INSTRUCTIONS wide
#define GCPDDA_NUM_LANES 4
#else
#define GCPDDA_INSTRUCTIONS portable
#define GCPDDA_NUM_LANES 2
#endif
