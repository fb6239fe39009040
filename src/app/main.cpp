// The command line: sub-commands, the MPI scope, exceptions to exit codes.

#include "app/blocks.hpp"
#include "app/condensed.hpp"
#include "app/first_scenes.hpp"
#include "app/launch.hpp"
#include "app/output_paths.hpp"
#include "app/report.hpp"
#include "app/root_file.hpp"
#include "app/versions.hpp"
#include "base/check.hpp"
#include "base/standard_output.hpp"
#include "driver/ensemble.hpp"
#include "driver/inspect.hpp"
#include "driver/restart.hpp"
#include "driver/safety_factor.hpp"
#include "driver/safety_search.hpp"
#include "driver/stop_signal.hpp"
#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/driver/run.hpp"
#include "gcpdda/io/scene_reader.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/hdf5/unclosed_files.hpp"
#include "io/results/result_directory.hpp"
#include "io/scene/record_file.hpp"
#include "io/scene/scene_reference.hpp"
#include "simulation/plausibility.hpp"
#include "simulation/plausible_ranges.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/scene_size.hpp"
#include "simulation/simulation.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <span>
#include <sstream>

namespace {

using namespace gcpdda;

struct Arguments {
  std::string scene;
  std::string directory;
  std::vector<std::string> sets;
  std::string svg;
  std::string json;
  std::vector<std::string> families;
  std::string tolerance; ///< and the next two: values of [fos]
  std::string from;
  std::string to;
  std::string settled;
  std::string count;                       ///< of [ensemble]
  std::string kind;                        ///< of a new scene
  std::vector<std::string> report_options; ///< as the Python package takes them
  int ranks = 0;
  bool overwrite = false;
  bool only_bound = false; ///< of fos
  bool accepts_gaps = false;
  std::string kept_in; ///< folder of the run to go on with, which has kept the lines of drawings
};

constexpr int most_subdomains = 1 << 20;
constexpr std::int64_t longest_scene = 64 << 20; // bytes; more than 10^4 inline blocks take

std::string read_scene_on_root(const Communicator &world, const std::string &path,
                               const std::string &who = "the scene") {
  return read_on_root(world, path, who, longest_scene);
}

void print(const Communicator &world, const Diagnostics &diagnostics) {
  if (world.is_root()) {
    for (const Diagnostic &d : condensed(diagnostics)) {
      std::cerr << to_string(d) << '\n';
    }
  }
}

/// The scene of a text and the arguments goes to `work`; every fault of it becomes text and
/// exit_code::bad_scene.
template <class Work>
ExitCode with_scene(const Communicator &world, const Arguments &arguments, const std::string &text,
                    Work &&work) {
  SceneReading reading = read_scene(text, arguments.scene, arguments.sets);
  print(world, reading.diagnostics);
  if (has_errors(reading.diagnostics)) {
    return exit_code::bad_scene;
  }
  try {
    prepare_region(world, reading.scene, arguments.kept_in);
    return work(reading.scene);
  } catch (const SceneError &error) {
    Diagnostics diagnostics = error.diagnostics();
    for (Diagnostic &d : diagnostics) {
      d.where.file = d.where.file.empty() ? arguments.scene : d.where.file;
    }
    print(world, diagnostics);
    return exit_code::bad_scene;
  }
}

/// Says before the work what the scene takes, if that is much; throws SceneError where it is too much.
/// @param copies  of the scene that are held at one time
void judge_before_work(const Communicator &world, const Arguments &arguments, const Scene &scene,
                       double copies = 1.0) {
  Diagnostics found = judge_size(world, scene, copies);
  if (has_errors(found)) {
    throw SceneError(found);
  }
  for (Diagnostic &d : found) {
    d.where.file = arguments.scene;
  }
  print(world, found);
}

template <class Work>
ExitCode with_scene(const Communicator &world, const Arguments &arguments, Work &&work) {
  return with_scene(world, arguments, read_scene_on_root(world, arguments.scene), work);
}

std::filesystem::path result_folder(const Arguments &arguments, const std::string &stem) {
  return arguments.directory.empty() ? std::filesystem::path("results") / stem
                                     : std::filesystem::path(arguments.directory);
}

ExitCode run(const Communicator &world, const Arguments &arguments) {
  return with_scene(world, arguments, [&](const Scene &scene) {
    judge_before_work(world, arguments, scene);
    RunOptions options;
    options.directory = result_folder(arguments, scene.stem);
    options.overwrite = arguments.overwrite;
    tell_joint_sets(world, scene, options);
    return run_scene(world, scene, options);
  });
}

ExitCode restart(const Communicator &world, Arguments arguments) {
  on_root(world, [&] { expect_run_to_restart(arguments.directory); });
  const std::filesystem::path scene = std::filesystem::path(arguments.directory) / "scene.toml";
  arguments.scene = scene.string();
  const bool has_other_maps =
      std::any_of(arguments.sets.begin(), arguments.sets.end(),
                  [](const std::string &set) { return set.starts_with("joint_map"); });
  arguments.kept_in = has_other_maps ? "" : arguments.directory;
  Arguments unchanged = arguments;
  unchanged.sets.clear();
  const SceneReading before = read_scene(read_scene_on_root(world, arguments.scene), arguments.scene, {});
  keep_intervals(before.scene.output, arguments.sets);
  return with_scene(world, has_errors(before.diagnostics) ? unchanged : arguments, [&](const Scene &after) {
    judge_before_work(world, arguments, after);
    RunOptions options;
    options.earlier = arguments.accepts_gaps ? EarlierResults::may_have_gaps : EarlierResults::must_be_whole;
    tell_joint_sets(world, after, options);
    return restart_scene(world, before.scene, after, arguments.directory, options);
  });
}

/// Throws FileError where the blocks of a `settled` folder have settled with another scene.
/// @return what strengths were divided by then
double factor_of_settled(const Communicator &world, const std::string &folder, const Scene &scene) {
  const std::string path = (std::filesystem::path(folder) / "scene.toml").string();
  const std::string text = read_scene_on_root(world, path, "the scene of the settled state");
  std::istringstream before(settling_part(text));
  std::istringstream now(settling_part(scene.resolved));
  std::string was;
  std::string is;
  do {
    was = std::getline(before, was) ? was : "the end";
    is = std::getline(now, is) ? is : "the end";
    if (was != is) {
      throw FileError(path + ": error: the blocks have settled with another scene, it says '" + was +
                      "' where this one says '" + is +
                      "', leave --settled out or give the state of this scene");
    }
  } while (before || now);
  const std::size_t end = text.find('\n');
  return text.starts_with(settled_weaker) ? std::stod(text.substr(settled_weaker.size(), end)) : 1.0;
}

/// What the command line says of the search goes the way of --set.
ExitCode fos(const Communicator &world, Arguments arguments) {
  std::string families;
  for (const std::string &name : arguments.families) {
    families += (families.empty() ? "\"" : ", \"") + name + '"';
  }
  if (!families.empty()) {
    arguments.sets.push_back("fos.families=[" + families + "]");
  }
  for (const auto &[key, value] : {std::pair("tolerance", arguments.tolerance),
                                   std::pair("from", arguments.from), std::pair("to", arguments.to)}) {
    if (!value.empty()) {
      arguments.sets.push_back(std::string("fos.") + key + '=' + value);
    }
  }
  return with_scene(world, arguments, [&](const Scene &scene) {
    judge_before_work(world, arguments, scene);
    SafetyOptions options;
    options.directory = result_folder(arguments, scene.stem + "_fos");
    options.overwrite = arguments.overwrite;
    options.only_bound = arguments.only_bound;
    if (!arguments.settled.empty()) {
      options.settled = arguments.settled;
      options.settled_factor = factor_of_settled(world, arguments.settled, scene);
    }
    return find_safety_factor(world, scene, options);
  });
}

/// Without what says how many members there are, and what becomes of them.
std::string identity_of(const std::string &text, const Arguments &arguments) {
  std::vector<std::string> sets = arguments.sets;
  sets.insert(sets.end(), {"ensemble.count=1", "ensemble.ranks=1", "ensemble.keep=false"});
  return read_scene(text, arguments.scene, sets).scene.resolved;
}

ExitCode ensemble(const Communicator &world, Arguments arguments) {
  if (!arguments.count.empty()) {
    arguments.sets.push_back("ensemble.count=" + arguments.count);
  }
  const std::string text = read_scene_on_root(world, arguments.scene);
  return with_scene(world, arguments, text, [&](const Scene &scene) {
    if (const Diagnostics faults = sets_without_effect(scene.ensemble, arguments.sets); !faults.empty()) {
      throw SceneError(faults);
    }
    judge_before_work(world, arguments, scene, copies_in(scene.ensemble, world.size()));
    Scene shaken = scene; // members are quiet, and tell of a record that cannot be read
    open_record(world, shaken);
    print(world, implausible_values(shaken));
    const auto member_scene = [&](const Communicator &group, const std::vector<double> &values) {
      std::vector<std::string> sets = arguments.sets;
      for (std::size_t i = 0; i < values.size(); ++i) {
        sets.push_back(assignment(scene.ensemble.variations[i], values[i]));
      }
      SceneReading reading = read_scene(text, arguments.scene, sets);
      if (has_errors(reading.diagnostics)) {
        throw SceneError(reading.diagnostics);
      }
      prepare_region(group, reading.scene);
      return std::move(reading.scene);
    };
    return run_ensemble(world, scene, member_scene,
                        {result_folder(arguments, scene.stem + "_ensemble"), arguments.overwrite,
                         identity_of(text, arguments)});
  });
}

ExitCode inspect(const Communicator &world, const Arguments &arguments) {
  return with_scene(world, arguments, [&](const Scene &scene) -> ExitCode {
    if (!are_files_of_their_own(world, arguments.scene, scene, {{"--svg", arguments.svg}})) {
      return exit_code::wrong_usage;
    }
    judge_before_work(world, arguments, scene);
    const std::string report = inspect_scene(world, scene, {arguments.ranks, arguments.svg});
    if (world.is_root()) {
      std::cout << report << words_on_joint_sets(scene) << std::flush;
    }
    return exit_code::done;
  });
}

ExitCode blocks(const Communicator &world, const Arguments &arguments) {
  return with_scene(world, arguments, [&](const Scene &scene) -> ExitCode {
    if (!are_files_of_their_own(
            world, arguments.scene, scene,
            {{"--svg", arguments.svg}, {"--json", arguments.json}, {"--out", arguments.directory}})) {
      return exit_code::wrong_usage;
    }
    Scene region = scene; // nothing else is made
    region.blocks.clear();
    region.generators.clear();
    judge_before_work(world, arguments, region);
    print(world, implausible_values(scene));
    cut_blocks(world, scene, {arguments.svg, arguments.json, arguments.directory});
    return exit_code::done;
  });
}

ExitCode new_scene(const Communicator &world, const Arguments &arguments) {
  write_first_scene(world, arguments.kind,
                    arguments.scene.empty() ? arguments.kind + ".toml" : arguments.scene);
  return exit_code::done;
}

ExitCode report(const Communicator &world, const Arguments &arguments) {
  std::vector<std::string> words = arguments.report_options;
  words.insert(words.end(), {"--", arguments.directory});
  return write_report(world, words);
}

void take_sets(CLI::App *command, Arguments &arguments) {
  command->add_option("--set", arguments.sets, "path=value: replace a value of the scene; repeatable")
      ->allow_extra_args(false);
}

void take_scene(CLI::App *command, Arguments &arguments) {
  command->add_option("SCENE", arguments.scene, "scene file (TOML)")->required();
  take_sets(command, arguments);
}

void add_run(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand("run", "run a scene");
  take_scene(command, arguments);
  command->add_option("--out", arguments.directory, "result folder; default results/<scene stem>");
  command->add_flag("--overwrite", arguments.overwrite, "replace an earlier run in the result folder");
}

const CLI::App *add_restart(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand(
      "restart", "go on with a stopped or broken run from its newest checkpoint, on any number of ranks");
  command->add_option("DIR", arguments.directory, "result folder")->required();
  take_sets(command, arguments);
  command->add_flag("--accept-gaps", arguments.accepts_gaps,
                    "go on though histories or frames from before the checkpoint are missing or damaged");
  return command;
}

const CLI::App *add_inspect(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand("inspect", "tell what a scene holds, costs and how it would be cut");
  take_scene(command, arguments);
  command->add_option("--ranks", arguments.ranks, "number of subdomains; default: ranks of this call")
      ->check(CLI::Range(1, most_subdomains));
  command->add_option("--svg", arguments.svg, "draw blocks and subdomains into this file");
  return command;
}

const CLI::App *add_blocks(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand(
      "blocks", "cut the region of a scene into blocks, check and draw them without a run");
  take_scene(command, arguments);
  command->add_option("--svg", arguments.svg, "draw the blocks into this file");
  command->add_option("--out", arguments.directory, "write the blocks into this block file (HDF5)");
  command->add_option("--json", arguments.json, "write the report for programs into this file");
  return command;
}

const CLI::App *add_fos(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand(
      "fos", "factor of safety by lowering the strength of joints from the settled state of a scene");
  take_scene(command, arguments);
  command->add_option("--out", arguments.directory, "result folder; default results/<scene stem>_fos");
  command->add_flag("--overwrite", arguments.overwrite, "replace an earlier search in the result folder");
  command
      ->add_option("--families", arguments.families,
                   "laws to weaken, a,b,...; default [fos] families, or all; repeatable")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--tolerance", arguments.tolerance, "width of the bracket at the end; default 0.01");
  command->add_option("--from", arguments.from, "factor that is expected to hold; default 0.5");
  command->add_option("--to", arguments.to, "factor that is expected to fail; default 4");
  command->add_flag(
      "--bound", arguments.only_bound,
      "only an upper bound of the factor by limit analysis at the settled state, without trials");
  command->add_option("--settled", arguments.settled,
                      "begin with the state in this folder, 'settled' of an earlier search with the same "
                      "scene; default: settle now");
  return command;
}

const CLI::App *add_ensemble(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand(
      "ensemble", "probability of failure: many members of a scene whose strengths or joints are drawn at "
                  "random; repeated, it goes on with what is missing");
  take_scene(command, arguments);
  command->add_option("--count", arguments.count, "number of members; default [ensemble] count");
  command->add_option("--out", arguments.directory, "result folder; default results/<scene stem>_ensemble");
  command->add_flag("--overwrite", arguments.overwrite, "replace an earlier ensemble in the result folder");
  return command;
}

const CLI::App *add_new(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand("new", "write a commented scene to begin with, which runs as it is");
  command->add_option("KIND", arguments.kind, "what the scene is about")
      ->required()
      ->check(CLI::IsMember(first_scene_names()));
  command->add_option("FILE", arguments.scene, "file to write; default KIND.toml");
  return command;
}

const CLI::App *add_report(CLI::App &app, Arguments &arguments) {
  CLI::App *command = app.add_subcommand(
      "report", "write one HTML file about the results of run, fos or ensemble; takes Python");
  command->add_option("DIR", arguments.directory, "result folder")->required();
  for (const auto &[name, meaning] :
       {std::pair("--out", "file to write; default DIR/report.html"),
        std::pair("--title", "heading; default: the name of the folder"),
        std::pair("--frames", "most frames of the player, 0 for none; default 40")}) {
    command->add_option_function<std::string>(
        name,
        [&arguments, option = std::string(name)](const std::string &value) {
          arguments.report_options.push_back(option + '=' + value);
        },
        meaning);
  }
  return command;
}

std::string list_of_exit_codes() {
  std::string text = "Exit codes:";
  for (const auto &[code, meaning] : exit_codes) {
    text += "\n  " + std::to_string(code) + "  " + meaning;
  }
  return text;
}

ExitCode dispatch(const Communicator &world, int argc, char **argv) {
  CLI::App app("gcpdda: block-by-block simulation of jointed rock slopes and tunnels");
  app.require_subcommand(1);
  app.footer(list_of_exit_codes());
  app.set_version_flag(
      "--version", [] { return versions(); }, "print the versions of program and libraries");
  Arguments arguments;
  const CLI::App *new_command = add_new(app, arguments);
  add_run(app, arguments);
  const CLI::App *restart_command = add_restart(app, arguments);
  const CLI::App *inspect_command = add_inspect(app, arguments);
  const CLI::App *blocks_command = add_blocks(app, arguments);
  const CLI::App *fos_command = add_fos(app, arguments);
  const CLI::App *ensemble_command = add_ensemble(app, arguments);
  const CLI::App *report_command = add_report(app, arguments);
  CLI::App *reference_command = app.add_subcommand("reference", "print all scene keys as a Markdown page");
  bool values = false;
  reference_command->add_flag("--values", values, "print the plausible values and their sources instead");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError &error) {
    // One voice; --help is no fault.
    const int code = world.is_root() ? app.exit(error) : error.get_exit_code();
    return code == 0 ? exit_code::done : exit_code::wrong_usage;
  }
  if (reference_command->parsed()) {
    if (world.is_root()) {
      std::cout << (values ? plausible_values_page() : scene_reference()) << std::flush;
    }
    return exit_code::done;
  }
  if (new_command->parsed()) {
    return new_scene(world, arguments);
  }
  if (report_command->parsed()) {
    return report(world, arguments);
  }
  if (restart_command->parsed()) {
    return restart(world, arguments);
  }
  if (fos_command->parsed()) {
    return fos(world, arguments);
  }
  if (ensemble_command->parsed()) {
    return ensemble(world, arguments);
  }
  if (blocks_command->parsed()) {
    return blocks(world, arguments);
  }
  return inspect_command->parsed() ? inspect(world, arguments) : run(world, arguments);
}

} // namespace

int main(int argc, char **argv) {
  if (heeds_stop_signal(argc, argv)) {
    catch_stop_signal(); // before MPI starts, which takes a while
  }
  const MpiScope mpi(argc, argv);
  const Communicator world = Communicator::world();
  if (world.size() == 1 && announced_ranks() > 1) {
    std::cerr << "error: the launcher started " << announced_ranks()
              << " processes but MPI connects only one, they would run as separate copies of the same scene, "
                 "start gcpdda "
                 "with the mpirun of the Open MPI it was built with\n";
    return exit_code::wrong_usage;
  }
  try {
    const ExitCode code = dispatch(world, argc, argv);
    on_root(world, flush_standard_output);
    return code;
  } catch (const FileError &error) { // agreed on by all ranks where it is thrown
    if (world.is_root()) {
      std::cerr << error.what() << '\n';
    }
    std::int64_t unclosed = has_unclosed_files() ? 1 : 0;
    world.max(std::span(&unclosed, 1));
    if (unclosed > 0) {
      MpiScope::abort(exit_code::file_trouble);
    }
    return exit_code::file_trouble;
  } catch (const std::bad_alloc &) {
    std::cerr << "error: rank " << world.rank()
              << " has run out of memory, see 'memory' of gcpdda inspect, use more machines, fewer ranks on "
                 "each or fewer blocks\n";
    if (world.size() > 1) {
      MpiScope::abort(exit_code::internal_error);
    }
    return exit_code::internal_error;
  } catch (const std::exception &error) { // seen by this rank alone, perhaps: take the others along
    std::cerr << "internal error on rank " << world.rank() << ": " << error.what() << '\n';
    if (world.size() > 1) {
      MpiScope::abort(exit_code::internal_error);
    }
    return exit_code::internal_error;
  }
}
