#include "driver/stop_signal.hpp"

#include <csignal>

namespace gcpdda {

namespace {

volatile std::sig_atomic_t came = 0;

void note_signal(int /*number*/) {
  came = 1;
}

} // namespace

void catch_stop_signal() {
  struct sigaction action = {};
  action.sa_handler = note_signal;
  action.sa_flags = SA_RESTART; // no write to a file is cut short
  sigemptyset(&action.sa_mask);
  sigaction(SIGUSR1, &action, nullptr);
}

bool stop_signal_came() {
  return came != 0;
}

void forget_stop_signal() {
  came = 0;
}

} // namespace gcpdda
