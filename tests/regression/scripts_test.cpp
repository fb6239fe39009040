// The scripts that ship: what shellcheck finds in them, and that they say what they are for.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace gcpdda::scripts_test {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::Outcome;
using testing::run_program;

const fs::path source = GCPDDA_SOURCE_DIR;

std::vector<std::string> scripts_below(const char *folder, const std::string &ending) {
  std::vector<std::string> found;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(source / folder)) {
    if (entry.path().extension() == ending) {
      found.push_back(entry.path().string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> shell_scripts() {
  std::vector<std::string> all = scripts_below("run", ".sh");
  const std::vector<std::string> of_tests = scripts_below("tests", ".sh");
  all.insert(all.end(), of_tests.begin(), of_tests.end());
  all.push_back((source / ".ci/run").string());
  return all;
}

TEST(Scripts, ShellcheckFindsNothing) {
  std::vector<std::string> words{"shellcheck", "-x", "-P", "SCRIPTDIR"};
  const std::vector<std::string> scripts = shell_scripts();
  EXPECT_GE(scripts.size(), 10U);
  words.insert(words.end(), scripts.begin(), scripts.end());
  const Outcome outcome = run_program(words, source);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

// Those of run/study import what takes a second each to load; CTest runs them.
TEST(Scripts, HelpIsPrintedAndNothingElseHappens) {
  const testing::WorkFolder folder;
  const auto expect_help = [&](const std::string &program, const std::string &script) {
    const Outcome outcome = run_program({program, script, "--help"}, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << script << outcome.err;
    EXPECT_GE(testing::lines_of(outcome.out).size(), 1U) << script;
    EXPECT_EQ(outcome.err, "") << script;
  };
  for (const std::string &script : shell_scripts()) {
    if (!script.ends_with("/set_up.sh") &&
        !script.ends_with("/.ci/run")) { // one is sourced, one takes no words
      expect_help("bash", script);
    }
  }
  for (const std::string &script : scripts_below("run", ".py")) {
    if (fs::path(script).parent_path() == source / "run") {
      expect_help("/usr/bin/python3", script);
    } else if (file_text(script).find("__main__") != std::string::npos) { // others are parts of one
      EXPECT_EQ(testing::count_of(file_text(script), "argparse.ArgumentParser(description=__doc__"), 1)
          << script;
    }
  }
  EXPECT_EQ(testing::listing(folder.path()), std::vector<std::string>());
}

std::size_t characters_of(const std::string &line) { // UTF-8: bytes that begin a character
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

TEST(Scripts, LinesOfPythonHaveAtMost120Characters) {
  std::vector<std::string> files;
  for (const char *folder : {"run/python", "tests/python"}) {
    const std::vector<std::string> found = scripts_below(folder, ".py");
    files.insert(files.end(), found.begin(), found.end());
  }
  for (const std::string &script : scripts_below("run", ".py")) {
    if (fs::path(script).parent_path() == source / "run") {
      files.push_back(script);
    }
  }
  EXPECT_GE(files.size(), 30U);
  for (const std::string &file : files) {
    std::size_t number = 0;
    for (const std::string &line : testing::lines_of(file_text(file))) {
      ++number;
      EXPECT_LE(characters_of(line), 120U) << file << ':' << number;
    }
  }
}

} // namespace
} // namespace gcpdda::scripts_test
