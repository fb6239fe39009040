// Every include line against the module table of the architecture. A layer that is only hoped for does not
// last: this test is what keeps physics free of MPI, the library free of files, and lower modules free of
// higher ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Rule {
  std::set<std::string> may_include; ///< transitive downwards
  std::set<std::string> must_never;  ///< beats what comes with the modules above
};

const std::map<std::string, Rule> modules{
    {"base", {}},
    {"geometry", {{"base"}, {}}},
    {"model", {{"geometry"}, {}}},
    {"contact", {{"model"}, {}}},
    {"dynamics", {{"model"}, {}}},
    {"blockgen", {{"model"}, {}}},
    {"partition", {{"geometry"}, {}}},
    {"communicator", {{"base"}, {}}},
    {"parallel", {{"model", "partition", "communicator"}, {}}},
    {"io", {{"model", "communicator"}, {}}},
    {"statics", {{"contact", "dynamics", "communicator"}, {}}},
    {"simulation", {{"contact", "dynamics", "statics", "parallel", "io"}, {}}},
    {"limit_analysis", {{"simulation"}, {"parallel"}}},
    {"driver", {{"limit_analysis"}, {"contact", "dynamics", "statics", "parallel"}}},
    {"app", {{"driver", "blockgen"}, {"contact", "dynamics", "statics", "parallel"}}},
};

/// Libraries that only some folders may see. Public headers, which stand under include/, see none of them.
struct Wall {
  const char *header; ///< regular expression
  std::vector<std::string> folders;
};

const std::vector<Wall> walls{
    {R"(mpi\.h)", {"src/parallel/", "src/io/"}}, {R"(metis\.h)", {"partition/"}},
    {R"(hdf5.*\.h|H5.*)", {"src/io/"}},          {R"(geos.*)", {"src/blockgen/"}},
    {R"(coin/.*)", {"src/limit_analysis/"}},     {R"(Eigen/.*)", {"src/dynamics/", "src/statics/"}},
    {R"(toml\+\+/.*|toml\.hpp)", {"src/io/"}},   {R"(CLI/.*)", {"src/app/", "partition/tool/"}},
};

const std::vector<std::string> walked_folders{"include/gcpdda", "src", "partition"};

/// The module of a path relative to the source folder.
std::optional<std::string> module_of(const std::string &path) {
  static const std::regex communicator(R"((include/gcpdda|src)/parallel/communicator[./].*)");
  static const std::regex folder(R"((?:include/gcpdda|src)/([^/]+)/.*)");
  std::smatch match;
  if (std::regex_match(path, communicator)) {
    return "communicator";
  }
  if (path.starts_with("partition/")) {
    return "partition";
  }
  if (std::regex_match(path, match, folder) && modules.contains(match[1])) {
    return match[1];
  }
  return std::nullopt;
}

/// All a module may include, itself among it.
std::set<std::string> reach(const std::string &module) {
  std::set<std::string> all{module};
  for (const std::string &lower : modules.at(module).may_include) {
    all.merge(reach(lower));
  }
  for (const std::string &banned : modules.at(module).must_never) {
    all.erase(banned);
  }
  return all;
}

struct Include {
  int line;
  std::string header;
  bool quoted;
};

std::vector<Include> includes_in(const std::string &text) {
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch match;
    if (std::regex_match(line, match, directive)) {
      includes.push_back({number, match[2], match[1] == "\""});
    }
  }
  return includes;
}

/// Where an include of ours leads, relative to the source folder; nothing for the headers of others.
std::optional<std::string> target_of(const Include &include) {
  if (include.header.starts_with("gcpdda/")) {
    return "include/" + include.header;
  }
  const std::string folder = include.header.substr(0, include.header.find('/'));
  if (include.quoted || modules.contains(folder)) {
    return folder == "partition" ? include.header : "src/" + include.header;
  }
  return std::nullopt;
}

std::string fault_of(const std::string &path, const std::string &module, const Include &include) {
  const std::optional<std::string> target = target_of(include);
  if (target) {
    const std::optional<std::string> other = module_of(*target);
    if (!other) {
      return "is not in a module of ours; other libraries go in angle brackets";
    }
    return reach(module).contains(*other) ? "" : module + " may not include " + *other;
  }
  for (const Wall &wall : walls) {
    const bool inside = std::any_of(wall.folders.begin(), wall.folders.end(),
                                    [&](const std::string &folder) { return path.starts_with(folder); });
    if (!inside && std::regex_match(include.header, std::regex(wall.header))) {
      return "is walled off from " + module;
    }
  }
  return "";
}

/// One line for each include of a file that breaks the table.
std::vector<std::string> faults_in(const std::string &path, const std::string &text) {
  const std::optional<std::string> module = module_of(path);
  if (!module) {
    return {path + ": belongs to no module of the table"};
  }
  std::vector<std::string> faults;
  for (const Include &include : includes_in(text)) {
    const std::string fault = fault_of(path, *module, include);
    if (!fault.empty()) {
      faults.push_back(path + ":" + std::to_string(include.line) + ": " + include.header + " " + fault);
    }
  }
  return faults;
}

bool is_source(const fs::path &path) {
  static const std::set<std::string> endings{".hpp", ".cpp", ".h", ".c", ".inl", ".ipp"};
  return endings.contains(path.extension().string());
}

std::string read(const fs::path &path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::map<std::string, std::string> sources() {
  const fs::path root = GCPDDA_SOURCE_DIR;
  std::map<std::string, std::string> texts;
  for (const std::string &folder : walked_folders) {
    for (const auto &entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.is_regular_file() && is_source(entry.path())) {
        texts[fs::relative(entry.path(), root).generic_string()] = read(entry.path());
      }
    }
  }
  return texts;
}

TEST(Includes, RespectTheModuleTable) {
  for (const auto &[path, text] : sources()) {
    for (const std::string &fault : faults_in(path, text)) {
      ADD_FAILURE() << fault;
    }
  }
}

TEST(Includes, TheWalkSawTheTree) {
  const auto texts = sources();
  std::set<std::string> seen;
  std::size_t num_includes = 0;
  for (const auto &[path, text] : texts) {
    seen.insert(module_of(path).value_or("none"));
    num_includes += includes_in(text).size();
  }
  EXPECT_GE(texts.size(), 20U);
  EXPECT_GE(num_includes, 100U);
  for (const char *module : {"base", "geometry", "model", "partition", "communicator", "io"}) {
    EXPECT_TRUE(seen.contains(module)) << module;
  }
  EXPECT_TRUE(texts.contains("include/gcpdda/parallel/communicator.hpp"));
}

TEST(Includes, LocalHeadersExist) {
  for (const auto &[path, text] : sources()) {
    for (const Include &include : includes_in(text)) {
      const std::optional<std::string> target = target_of(include);
      if (target) {
        EXPECT_TRUE(fs::exists(fs::path(GCPDDA_SOURCE_DIR) / *target)) << path << ":" << include.line;
      }
    }
  }
}

// Who has the public headers alone can compile against them.
TEST(Includes, OfPublicHeadersArePublic) {
  std::size_t found = 0;
  for (const auto &[path, text] : sources()) {
    if (path.starts_with("include/")) {
      ++found;
      for (const Include &include : includes_in(text)) {
        EXPECT_TRUE(!include.quoted || include.header.starts_with("gcpdda/"))
            << path << ":" << include.line << ": " << include.header;
      }
    }
  }
  EXPECT_GE(found, 10U);
}

/// The first file found that includes itself on some way, with the way; nothing where there is none.
std::vector<std::string> circle_in(const std::map<std::string, std::string> &texts) {
  std::set<std::string> done;
  std::vector<std::string> way;
  std::vector<std::string> circle;
  const std::function<bool(const std::string &)> visit = [&](const std::string &path) {
    if (const auto before = std::find(way.begin(), way.end(), path); before != way.end()) {
      circle.assign(before, way.end());
      return true;
    }
    if (done.contains(path) || !texts.contains(path)) {
      return false;
    }
    way.push_back(path);
    for (const Include &include : includes_in(texts.at(path))) {
      const std::optional<std::string> target = target_of(include);
      if (target && visit(*target)) {
        return true;
      }
    }
    way.pop_back();
    done.insert(path);
    return false;
  };
  std::any_of(texts.begin(), texts.end(), [&](const auto &text) { return visit(text.first); });
  return circle;
}

TEST(Includes, MakeNoCircle) {
  EXPECT_EQ(circle_in({{"src/io/a.hpp", "#include \"io/b.hpp\""}, {"src/io/b.hpp", "#include \"io/a.hpp\""}}),
            (std::vector<std::string>{"src/io/a.hpp", "src/io/b.hpp"}));
  EXPECT_EQ(circle_in(sources()), std::vector<std::string>());
}

/// A file opens with what it is for: a comment, or as a source the header of its own name.
bool opens_with_its_purpose(const std::string &path, const std::string &text) {
  if (path.ends_with(".hpp")) {
    return text.starts_with("#pragma once\n\n//");
  }
  const std::vector<Include> includes = includes_in(text);
  const std::string own = fs::path(path).stem().string() + ".hpp";
  return text.starts_with("//") || (!includes.empty() && fs::path(includes.front().header).filename() == own);
}

TEST(Files, OpenWithTheirPurpose) {
  EXPECT_TRUE(opens_with_its_purpose("a/b.cpp", "#include \"a/b.hpp\"\n"));
  EXPECT_FALSE(opens_with_its_purpose("a/b.cpp", "#include \"a/c.hpp\"\n"));
  EXPECT_FALSE(opens_with_its_purpose("a/b.hpp", "#pragma once\n\n#include <vector>\n"));
  for (const auto &[path, text] : sources()) {
    EXPECT_TRUE(opens_with_its_purpose(path, text)) << path;
  }
}

/// Whether the header of a source stands beside it or among the public ones. A copy of a source for some
/// instruction set has the header of that source.
bool has_its_header(const std::string &path, const std::map<std::string, std::string> &texts) {
  static const std::regex ending(R"((_avx(2|512))?\.cpp$)");
  const std::string header = std::regex_replace(path, ending, ".hpp");
  const std::string name = "/" + fs::path(header).filename().string();
  return texts.contains(header) || std::any_of(texts.begin(), texts.end(), [&](const auto &text) {
           return text.first.starts_with("include/") && text.first.ends_with(name);
         });
}

// What a stranger finds declared in a header is in the source of its name.
TEST(Files, SourcesHaveTheHeaderOfTheirName) {
  EXPECT_TRUE(has_its_header("src/io/a_avx2.cpp", {{"src/io/a.hpp", ""}}));
  EXPECT_TRUE(has_its_header("src/io/b/a.cpp", {{"include/gcpdda/io/a.hpp", ""}}));
  EXPECT_FALSE(has_its_header("src/io/a.cpp", {{"src/io/b/a.hpp", ""}}));
  const std::set<std::string> have_none{
      "src/app/main.cpp", "partition/tool/main.cpp",
      "src/app/large_pages.cpp"}; // operators new and delete of the language
  const auto texts = sources();
  std::size_t found = 0;
  for (const auto &[path, text] : texts) {
    if (!path.ends_with(".cpp") || have_none.contains(path)) {
      continue;
    }
    ++found;
    EXPECT_TRUE(has_its_header(path, texts)) << path;
  }
  EXPECT_GE(found, 100U);
}

struct Planted {
  const char *path;
  const char *line;
};

TEST(Includes, PlantedFaultsAreCaught) {
  const std::array<Planted, 20> bad{{
      {"src/base/check.cpp", "#include \"gcpdda/geometry/vec2.hpp\""},
      {"include/gcpdda/geometry/vec2.hpp", "#include \"gcpdda/model/scene.hpp\""},
      {"src/contact/law.cpp", "#include \"dynamics/scheme.hpp\""},
      {"src/dynamics/scheme.cpp", "#include \"gcpdda/parallel/communicator.hpp\""},
      {"src/dynamics/scheme.cpp", "  #  include <contact/laws/law.hpp> // spaced, in angle brackets"},
      {"src/dynamics/scheme.cpp", "#include \"contact/private.hpp\""},
      {"src/parallel/communicator/communicator.cpp", "#include \"gcpdda/model/scene.hpp\""},
      {"src/parallel/ghosts.cpp", "#include \"contact/laws/law.hpp\""},
      {"src/statics/springs.cpp", "#include \"parallel/ghosts.hpp\""},
      {"src/io/writer.cpp", "#include \"parallel/ghosts.hpp\""},
      {"src/driver/run.cpp", "#include \"blockgen/joints.hpp\""},
      {"src/app/main.cpp", "#include \"dynamics/scheme.hpp\""},
      {"src/driver/run.cpp", "#include \"contact/laws/region_law.hpp\""},
      {"src/driver/run.cpp", "#include <mpi.h>"},
      {"include/gcpdda/parallel/communicator.hpp", "#include <mpi.h>"},
      {"src/parallel/rebalance.cpp", "#include <metis.h>"},
      {"src/driver/run.cpp", "#include <hdf5.h>"},
      {"src/model/scene.cpp", "#include <H5Fpublic.h>"},
      {"src/contact/law.cpp", "#include <Eigen/Dense>"},
      {"src/utils/strings.cpp", "#include <string>"},
  }};
  for (const Planted &plant : bad) {
    EXPECT_EQ(faults_in(plant.path, std::string("#pragma once\n") + plant.line + "\n").size(), 1U)
        << plant.path << " " << plant.line;
  }
}

TEST(Includes, LegalOnesAreNot) {
  const std::array<Planted, 9> good{{
      {"src/contact/law.cpp", "#include \"base/ids.hpp\""},
      {"src/contact/law.cpp", "#include \"contact/envelope.hpp\""},
      {"src/contact/law.cpp", "// #include <mpi.h>"},
      {"src/driver/run.cpp", "#include \"partition/domain_map.hpp\""},
      {"src/parallel/communicator/communicator.cpp", "#include <mpi.h>"},
      {"src/io/writer.cpp", "#include <hdf5.h>"},
      {"src/dynamics/scheme.cpp", "#include <Eigen/Dense>"},
      {"src/app/main.cpp", "#include \"gcpdda/model/scene.hpp\""},
      {"partition/tool/main.cpp", "#include \"partition/curve_cut.hpp\""},
  }};
  for (const Planted &plant : good) {
    EXPECT_EQ(faults_in(plant.path, plant.line), std::vector<std::string>()) << plant.line;
  }
}

// A layer cannot be respected both ways round.
TEST(ModuleTable, HasNoCircle) {
  for (const auto &[module, rule] : modules) {
    for (const std::string &lower : rule.may_include) {
      ASSERT_TRUE(modules.contains(lower)) << lower;
      EXPECT_FALSE(reach(lower).contains(module)) << module << " and " << lower;
    }
  }
}

// A lower module that is handed a function calls upwards, which no include line shows.
TEST(Callbacks, AreTakenByNoModuleOfTheStep) {
  const std::set<std::string> lower{"geometry", "model",    "contact",     "dynamics",
                                    "statics",  "parallel", "communicator"};
  std::set<std::string> seen;
  for (const auto &[path, text] : sources()) {
    const std::string module = module_of(path).value_or("none");
    if (lower.contains(module)) {
      seen.insert(module);
      EXPECT_EQ(text.find("std::function"), std::string::npos) << path;
    }
  }
  EXPECT_EQ(seen, lower);
}

/// Words that the product does not use, and what it says instead.
const std::map<std::string, std::string> banned_words{
    {"own_step", "block_solve"},
    {"OwnStep", "BlockSolve"},
    {"restless", "rows_to_check"},
    {"calm", "safe_motion, settled"},
    {"note_broken", "add_broken"},
    {"strangers", "pairs without a region"},
    {"strangers_", "without_region_"},
    {"LaneSide", "LaneChain"},
    {"PairSides", "PairChains"},
    {"sides_", "edges_"},
    {"astray", "moved_beyond_sag"},
    {"press", "apply_in_situ_stress; surfaces push"},
    {"pressed_", "in_situ_overlap_"},
    {"size_up", "find_model_sizes"},
    {"steps_between_looks", "steps_between_verdicts"},
    {"Front", "PairGroup"},
};

/// One line for each banned word of a file.
std::vector<std::string> banned_in(const std::string &path, const std::string &text) {
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::vector<std::string> found;
  auto begin = std::find_if(text.begin(), text.end(), is_letter);
  while (begin != text.end()) {
    const auto end = std::find_if_not(begin, text.end(), is_letter);
    if (const auto word = banned_words.find(std::string(begin, end)); word != banned_words.end()) {
      found.push_back(path + ":" + std::to_string(1 + std::count(text.begin(), begin, '\n')) + ": '" +
                      word->first + "', say " + word->second);
    }
    begin = std::find_if(end, text.end(), is_letter);
  }
  return found;
}

TEST(Words, AreThoseOfTheMethod) {
  for (const auto &[path, text] : sources()) {
    for (const std::string &fault : banned_in(path, text)) {
      ADD_FAILURE() << fault;
    }
  }
}

TEST(Words, BannedOnesAreSeen) {
  EXPECT_EQ(banned_in("a.cpp", "int x;\nint calm = 1; // press\n"),
            (std::vector<std::string>{"a.cpp:2: 'calm', say safe_motion, settled",
                                      "a.cpp:2: 'press', say apply_in_situ_stress; surfaces push"}));
  EXPECT_TRUE(banned_in("a.cpp", "double pressure = calms_down;").empty());
}

TEST(TopLevel, HoldsWhatIsPrescribedOnly) {
  const std::set<std::string> prescribed{"CMakeLists.txt", "CMakePresets.json", "README.md", "src",
                                         "include",        "partition",         "tests",     "run"};
  std::size_t found = 0;
  for (const auto &entry : fs::directory_iterator(GCPDDA_SOURCE_DIR)) {
    const std::string name = entry.path().filename().string();
    const bool product = name.starts_with("build") || name == "results";
    found += prescribed.contains(name) ? 1 : 0;
    EXPECT_TRUE(prescribed.contains(name) || name.starts_with(".") || product) << name;
  }
  EXPECT_GE(found, 6U);
}

} // namespace
