#include "incline.hpp"
#include <gtest/gtest.h>
#include <fmt/format.h>
namespace gcpdda::testing { TEST(Tmp, Print) { const Incline i; for (auto v : i.plane()) fmt::print("P [{:.17g}, {:.17g}]\n", v.x, v.y); for (auto v : i.sliding_square()) fmt::print("S [{:.17g}, {:.17g}]\n", v.x, v.y);} }
