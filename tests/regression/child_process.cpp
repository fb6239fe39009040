#include "child_process.hpp"

#include "support/run_facts.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string_view>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char **environ;

namespace gcpdda::testing {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> clean_environment(const std::vector<std::string> &added) {
  std::vector<std::string> variables;
  for (char **variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    bool of_launcher = false;
    for (const char *prefix : {"OMPI_", "PMIX_", "PMI_", "ORTE_", "OPAL_", "SLURM_"}) {
      of_launcher = of_launcher || text.starts_with(prefix);
    }
    // Of a variable that is there twice some programs see the first, others the last.
    const bool is_replaced = std::any_of(added.begin(), added.end(), [&](const std::string &other) {
      return text.starts_with(std::string_view(other).substr(0, other.find('=') + 1));
    });
    if (!of_launcher && !is_replaced) {
      variables.emplace_back(text);
    }
  }
  for (const char *needed :
       {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "OMPI_MCA_mpi_yield_when_idle=1",
        "OMPI_MCA_btl_vader_single_copy_mechanism=none", "OMP_NUM_THREADS=1",
        // Most of a small run is its start and its end: one node, shared memory, no daemon for a single rank,
        // and after a failure no two seconds of waiting for ranks that have all said why and gone.
        "OMPI_MCA_pml=ob1", "OMPI_MCA_btl=self,vader", "OMPI_MCA_ess_singleton_isolated=1",
        "OMPI_MCA_odls_base_sigkill_timeout=0"}) {
    variables.emplace_back(needed);
  }
  // Single ranks without a daemon all take the same name for their scratch files: each has a place of its
  // own.
  static const WorkFolder scratch;
  static int num_children = 0;
  const fs::path own = scratch / std::to_string(num_children++);
  fs::create_directory(own);
  variables.emplace_back("OMPI_MCA_orte_tmpdir_base=" + own.string());
  variables.insert(variables.end(), added.begin(), added.end());
  return variables;
}

std::vector<char *> pointers(std::vector<std::string> &texts) {
  std::vector<char *> list;
  for (std::string &text : texts) {
    list.push_back(text.data());
  }
  list.push_back(nullptr);
  return list;
}

/// Status of a child that ends in time; otherwise its whole group is killed.
int wait_for(pid_t child) {
  int status = 0;
  if (!wait_until([&] { return waitpid(child, &status, WNOHANG) != 0; })) {
    kill(-child, SIGKILL);
    waitpid(child, &status, 0);
    return 1000;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

bool wait_until(const std::function<bool()> &done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(20);
  while (!done()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

std::string own_lines(const std::string &standard_error) {
  static const std::regex of_component(R"(\[[^\]\s]+[:/][^\]\s]+\].*|\*.*)");
  const std::string row_of_dashes(74, '-');
  std::vector<std::string> lines = lines_of(standard_error);
  std::string own;
  for (auto line = lines.begin(); line != lines.end(); ++line) {
    const auto end = *line == row_of_dashes ? std::find(line + 1, lines.end(), row_of_dashes) : lines.end();
    if (end != lines.end()) {
      line = end;
    } else if (!std::regex_match(*line, of_component)) {
      own += *line + '\n';
    }
  }
  return own;
}

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "gcpdda_regression_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("no temporary folder");
  }
  path_ = name;
}

void WorkFolder::write(const std::string &name, const std::string &text) const {
  std::ofstream file(path_ / name, std::ios::binary);
  file << text;
}

Process::Process(const std::vector<std::string> &words, const fs::path &folder,
                 const std::vector<std::string> &environment) {
  std::vector<std::string> arguments = words;
  std::vector<std::string> variables = clean_environment(environment);
  const std::vector<char *> argv = pointers(arguments);
  const std::vector<char *> envp = pointers(variables);
  const std::string out = *streams_ / "out";
  const std::string err = *streams_ / "err";
  child_ = fork();
  if (child_ == 0) {
    setpgid(0, 0);
    const int in = open("/dev/null", O_RDONLY);
    const int to_out = open(out.c_str(), O_CREAT | O_WRONLY, 0600);
    const int to_err = open(err.c_str(), O_CREAT | O_WRONLY, 0600);
    if (chdir(folder.c_str()) == 0 && dup2(in, 0) == 0 && dup2(to_out, 1) == 1 && dup2(to_err, 2) == 2) {
      execvpe(argv[0], argv.data(), envp.data());
    }
    _exit(127);
  }
  if (child_ < 0) {
    throw std::runtime_error("cannot fork");
  }
}

Process::~Process() {
  if (!ended_) {
    kill(-child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
}

std::vector<pid_t> Process::children() const {
  std::vector<pid_t> found;
  for (const fs::directory_entry &entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) {
      continue;
    }
    std::ifstream file(entry.path() / "stat");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t behind_name = text.rfind(')'); // "pid (name) state parent ..."
    if (behind_name != std::string::npos &&
        std::stoi(text.substr(std::min(behind_name + 4, text.size()))) == child_) {
      found.push_back(std::stoi(name));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void Process::wait_until(const std::function<bool()> &done) const {
  testing::wait_until([&] {
    siginfo_t end = {};
    return done() || (waitid(P_PID, static_cast<id_t>(child_), &end, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                      end.si_pid != 0);
  });
}

Outcome Process::wait() {
  Outcome outcome;
  outcome.exit_code = wait_for(child_);
  ended_ = true;
  outcome.out = file_text(*streams_ / "out");
  const std::string err = file_text(*streams_ / "err");
  outcome.err = own_lines(err);
  if (outcome.exit_code == 128 + SIGSEGV || outcome.exit_code == 128 + SIGABRT) { // MPI's words say where
    std::cerr << err;
  }
  return outcome;
}

Outcome run_program(const std::vector<std::string> &words, const fs::path &folder,
                    const std::vector<std::string> &environment) {
  return Process(words, folder, environment).wait();
}

std::vector<std::string> gcpdda_words(int ranks, const std::vector<std::string> &arguments) {
  std::vector<std::string> words;
  if (ranks > 0) {
    words = {GCPDDA_MPIEXEC, "-n", std::to_string(ranks), "--oversubscribe", "--bind-to", "none"};
  }
  words.emplace_back(GCPDDA_EXECUTABLE);
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

Outcome run_gcpdda(int ranks, const std::vector<std::string> &arguments, const WorkFolder &folder) {
  return run_program(gcpdda_words(ranks, arguments), folder.path());
}

} // namespace gcpdda::testing
