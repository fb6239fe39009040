#include "gcpdda/base/lanes_of_build.hpp"

#include "lane_step.hpp"

namespace gcpdda {

DeformableStepper deformable_stepper(Instructions instructions) {
  DeformableStepper stepper{0, nullptr};
  if (instructions == Instructions::widest) {
    stepper = avx512_stepper();
  }
  if (stepper.step == nullptr && instructions != Instructions::portable) {
    stepper = avx2_stepper();
  }
  return stepper.step != nullptr ? stepper : GCPDDA_INSTRUCTIONS::stepper;
}

} // namespace gcpdda
