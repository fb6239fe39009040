#include "gcpdda/driver/stepwise_run.hpp"

#include "driver/run_words.hpp"
#include "simulation/energy_ledger.hpp"
#include "simulation/results.hpp"
#include "simulation/simulation.hpp"

#include <utility>

namespace gcpdda {

struct StepwiseRun::Parts {
  Parts(const Communicator &communicator, Scene scene)
      : simulation(communicator, std::move(scene)), ledger(simulation.state()) {}

  void end_stage_if_over() {
    if (simulation.is_staged() && simulation.stage_is_over() && !simulation.fault()) {
      ledger.note_end(simulation.state());
      simulation.end_stage(); // a settled pile is set to rest
      ledger.step_over(simulation.state());
    }
  }

  Simulation simulation;
  EnergyLedger ledger;
};

StepwiseRun::StepwiseRun(const Communicator &communicator, Scene scene)
    : parts_(std::make_unique<Parts>(communicator, std::move(scene))) {
  parts_->end_stage_if_over();
}

StepwiseRun::~StepwiseRun() = default;

void StepwiseRun::step() {
  Simulation &simulation = parts_->simulation;
  while (simulation.stage_is_over() && !simulation.finished()) { // a stage may take no step
    simulation.begin_next_stage();
    parts_->ledger.step_over(simulation.state());
  }
  if (!simulation.stage_is_over()) {
    simulation.step();
    parts_->end_stage_if_over();
  }
}

bool StepwiseRun::is_finished() const {
  return parts_->simulation.finished();
}

std::optional<std::string> StepwiseRun::fault() const {
  return parts_->simulation.fault() ? std::optional(fault_message(parts_->simulation)) : std::nullopt;
}

double StepwiseRun::time() const {
  return parts_->simulation.time();
}

double StepwiseRun::time_step() const {
  return parts_->simulation.plan().time_step;
}

std::int64_t StepwiseRun::step_count() const {
  return parts_->simulation.step_count();
}

std::int64_t StepwiseRun::stage() const {
  return parts_->simulation.stage().index;
}

std::int64_t StepwiseRun::num_blocks() const {
  return parts_->simulation.num_blocks();
}

const Diagnostics &StepwiseRun::notes() const {
  return parts_->simulation.notes();
}

std::vector<FrameRow> StepwiseRun::blocks(std::vector<Vec2> *vertices) {
  std::vector<FrameRow> rows;
  std::vector<Vec2> corners;
  SimulationFrame(parts_->simulation).append(0, num_blocks(), rows, corners);
  if (vertices != nullptr) {
    *vertices = std::move(corners);
  }
  return rows;
}

std::vector<ContactRow> StepwiseRun::contacts() {
  std::vector<ContactRow> rows;
  SimulationContacts(parts_->simulation).append(0, num_blocks(), rows);
  return rows;
}

EnergyRow StepwiseRun::energy() {
  return parts_->ledger.row(parts_->simulation.state());
}

void StepwiseRun::write_frame(FrameWriter &frames, int index) {
  frames.write(index, time(), SimulationFrame(parts_->simulation));
  frames.write_contacts(index, time(), SimulationContacts(parts_->simulation));
}

} // namespace gcpdda
