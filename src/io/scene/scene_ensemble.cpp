#include "io/scene/scene_ensemble.hpp"

#include "base/edit_distance.hpp"
#include "base/text.hpp"
#include "gcpdda/io/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gcpdda::scene_text {

namespace {

/// A key and the distributions it belongs to.
struct KeyOfDistributions {
  const char *key;
  std::vector<Distribution> required;
  std::vector<Distribution> optional;
};

const std::vector<KeyOfDistributions> &keys_of_distributions() {
  using enum Distribution;
  static const std::vector<KeyOfDistributions> table{
      {"mean", {normal, lognormal}, {}},
      {"deviation", {normal, lognormal}, {}},
      {"min", {uniform, triangular}, {normal, lognormal}},
      {"max", {uniform, triangular}, {normal, lognormal}},
      {"mode", {triangular}, {}},
  };
  return table;
}

bool is_among(const std::vector<Distribution> &list, Distribution distribution) {
  return std::count(list.begin(), list.end(), distribution) > 0;
}

class EnsembleReader {
public:
  EnsembleReader(const SceneSource &source, const Scene &scene) : source_(source), scene_(scene) {}

  Ensemble read() {
    Ensemble ensemble;
    const Section table = section(source_.root, "ensemble", source_.faulty);
    table.read("count", ensemble.count);
    table.read("seed", ensemble.seed);
    table.read_choice("ensemble", "measure", ensemble.measure);
    table.read("ranks", ensemble.ranks);
    table.read("keep", ensemble.keep);
    table.read("largest_displacement", ensemble.largest_displacement);
    for (const Section &vary : table.list("vary")) {
      ensemble.variations.push_back(read_variation(vary));
    }
    if (const toml::node *list = table.sound("vary"); list != nullptr && ensemble.variations.empty()) {
      fault(*list, table.subject("vary") + " is empty", "all members would be the same",
            "write [[ensemble.vary]] with a key and its distribution");
    }
    read_correlations(table, ensemble);
    if (ensemble.measure == Measure::verdict && table.sound("measure") != nullptr) {
      expect_verdict(*table.given("measure"));
    }
    if (table.sound("largest_displacement") != nullptr) {
      expect_shaking(*table.given("largest_displacement"), ensemble.measure);
    }
    return ensemble;
  }

private:
  /// Where the verdict of the members is asked for, a run has to give one.
  void expect_verdict(const toml::node &measure) {
    const auto last = std::find_if(scene_.stages.rbegin(), scene_.stages.rend(),
                                   [](const Stage &stage) { return stage.takes_steps(); });
    if (last != scene_.stages.rend() && !last->until_verdict) {
      fault(measure, fmt::format("'measure' in [ensemble] is verdict, and stage '{}' has none", last->name),
            "a run of a given duration does not say whether the blocks stand",
            "give that stage a limit in place of its duration");
    }
  }

  /// A permanent displacement is one since the ground began to shake, and a search has none.
  void expect_shaking(const toml::node &largest, Measure measure) {
    const bool searches = measure == Measure::factor;
    if (searches || !scene_.earthquake.shakes()) {
      fault(largest, "'largest_displacement' in [ensemble] has no meaning",
            searches ? "measure is factor, and a factor is that of blocks that were never shaken"
                     : "the scene has no [earthquake]",
            searches ? "leave it out, or use measure = \"verdict\"" : "leave it out");
    }
  }

  void fault(const toml::node &node, std::string what, std::string why, std::string hint) {
    source_.faults.add(node.source(), std::move(what), std::move(why), std::move(hint));
  }

  Variation read_variation(const Section &vary) {
    Variation variation;
    variation.key = vary.text("key").value_or("");
    vary.read_choice("ensemble.vary[]", "distribution", variation.distribution);
    vary.read("mean", variation.mean);
    vary.read("deviation", variation.deviation);
    vary.read("min", variation.min);
    vary.read("max", variation.max);
    vary.read("mode", variation.mode);
    if (const toml::node *key = vary.sound("key")) {
      variation.where = source_.faults.origins().position(key->source());
      expect_key(*key, variation.key);
    }
    if (vary.sound("distribution") != nullptr && has_own_keys(vary, variation.distribution)) {
      expect_shape(vary, variation);
    }
    return variation;
  }

  /// What can be said of a key without a reading of the scene with another value (scene_reader.cpp).
  void expect_key(const toml::node &node, const std::string &key) {
    if (std::count(keys_.begin(), keys_.end(), key) > 0) {
      fault(node, fmt::format("'{}' varies twice", key), "it has one value in each member",
            "leave one of them out");
    }
    keys_.push_back(key);
    if (key.starts_with("ensemble.") || key.starts_with("fos.")) {
      fault(node, fmt::format("'{}' cannot vary", key), "it says how members are compared",
            "for example key = \"joint.default.friction_angle_deg\"");
    }
    if (key.starts_with("joint.") &&
        std::count(key.begin(), key.end(), '.') > 1) { // a new one would be legal
      const std::string name = key.substr(6, key.rfind('.') - 6);
      std::vector<std::string> names;
      for (const JointLaw &law : scene_.joints.laws) {
        names.push_back(law.name);
      }
      if (std::count(names.begin(), names.end(), name) == 0) {
        const std::string near = nearest_word(name, names);
        fault(node, fmt::format("no joint is named '{}'", name), "",
              near.empty() ? fmt::format("add a table [joint.{}]", name)
                           : fmt::format("did you mean '{}'?", near));
      }
    }
    expect_no_stage_sets(node, key);
  }

  void expect_no_stage_sets(const toml::node &node, const std::string &key) {
    for (const Section &stage : listed_sections(source_.root, "stage", source_.faulty)) {
      const toml::node *set = stage.sound("set");
      const toml::node *value = set != nullptr ? set->as_table()->get(key) : nullptr;
      if (value != nullptr) {
        fault(node, fmt::format("'{}' cannot vary", key),
              fmt::format("{} sets it at {}", stage.label(), source_.faults.origins().place(value->source())),
              "leave it out there, or vary another key");
      }
    }
  }

  bool has_own_keys(const Section &vary, Distribution distribution) {
    const std::string word = words_of(
        find_key("ensemble.vary[]", "distribution")->choices)[static_cast<std::size_t>(distribution)];
    bool sound = true;
    for (const KeyOfDistributions &belongs : keys_of_distributions()) {
      const toml::node *node = vary.given(belongs.key);
      const bool required = is_among(belongs.required, distribution);
      if (node == nullptr && required) {
        source_.faults.add(vary.source(), vary.subject(belongs.key) + " is missing",
                           fmt::format("a {} distribution needs it", word),
                           fmt::format("for example {} = {}", belongs.key,
                                       find_key("ensemble.vary[]", belongs.key)->example));
      } else if (node != nullptr && !required && !is_among(belongs.optional, distribution)) {
        fault(*node, vary.subject(belongs.key) + " has no meaning",
              fmt::format("the distribution is {}", word), "leave it out");
      }
      sound = sound && vary.known(belongs.key) && (node != nullptr || !required);
    }
    return sound;
  }

  void expect_shape(const Section &vary, const Variation &variation) {
    const toml::node &shape = *vary.given("distribution");
    if (variation.distribution == Distribution::lognormal && variation.mean <= 0.0) {
      fault(*vary.given("mean"), fmt::format("{} is {}", vary.subject("mean"), variation.mean),
            "a lognormal value is above 0", "use a larger one, or another distribution");
    } else if (variation.min >= variation.max) {
      fault(*vary.given("max"),
            fmt::format("{} is {} and min is {}", vary.subject("max"), variation.max, variation.min),
            "values lie between them", "use a larger max");
    } else if (variation.distribution == Distribution::triangular &&
               (variation.mode < variation.min || variation.mode > variation.max)) {
      fault(*vary.given("mode"), fmt::format("{} is {}", vary.subject("mode"), variation.mode),
            "it lies between min and max", "move it there");
    } else if (constexpr double least = 1e-6; variation.share_within() < least) {
      fault(shape, fmt::format("{} has almost nothing between min and max", vary.label()),
            fmt::format("only {:.1g} of the distribution lies there", variation.share_within()),
            "move mean, min or max");
    }
  }

  void read_correlations(const Section &table, Ensemble &ensemble) {
    const std::size_t n = ensemble.variations.size();
    std::vector<double> matrix(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * n + i] = 1.0;
    }
    const std::vector<Section> list = table.list("correlation");
    bool sound = !list.empty();
    for (const Section &pair : list) {
      double coefficient = 0.0;
      pair.read("coefficient", coefficient);
      const toml::node *keys = pair.sound("keys");
      if (keys == nullptr) {
        sound = false;
        continue;
      }
      const std::size_t a = index_of((*keys->as_array())[0], ensemble);
      const std::size_t b = index_of((*keys->as_array())[1], ensemble);
      if (a < n && b < n && (a == b || matrix[a * n + b] != 0.0)) {
        fault(*keys, fmt::format("{} says again how these two go together", pair.subject("keys")),
              a == b ? "a value goes with itself" : "another table has said so", "leave it out");
      }
      sound = sound && a < n && b < n && a != b;
      if (sound) {
        matrix[a * n + b] = coefficient;
        matrix[b * n + a] = coefficient;
      }
    }
    if (sound) {
      ensemble.correlation_factor = lower_factor(matrix, n);
      if (ensemble.correlation_factor.empty()) {
        fault(*table.given("correlation"), "no values can be correlated like this",
              "the matrix of the coefficients is not positive definite", "use smaller coefficients");
      }
    }
  }

  std::size_t index_of(const toml::node &name, const Ensemble &ensemble) {
    const std::string &key = name.as_string()->get();
    const auto found = std::find_if(ensemble.variations.begin(), ensemble.variations.end(),
                                    [&](const Variation &variation) { return variation.key == key; });
    if (found == ensemble.variations.end()) {
      const std::string near = nearest_word(key, keys_);
      fault(name, fmt::format("'{}' does not vary", key), "a correlation is one of two values that do",
            near.empty() ? "add it as [[ensemble.vary]]" : fmt::format("did you mean '{}'?", near));
    }
    return static_cast<std::size_t>(found - ensemble.variations.begin());
  }

  SceneSource source_;
  const Scene &scene_;
  std::vector<std::string> keys_;
};

} // namespace

Ensemble read_ensemble(const SceneSource &source, const Scene &scene) {
  return source.root.contains("ensemble") ? EnsembleReader(source, scene).read() : Ensemble();
}

} // namespace gcpdda::scene_text

namespace gcpdda {

Diagnostics sets_without_effect(const Ensemble &ensemble, const std::vector<std::string> &sets) {
  const scene_text::Origins origins({}, sets);
  Diagnostics found;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    std::string path(trimmed(std::string_view(sets[i]).substr(0, sets[i].find('='))));
    std::erase_if(path, [](char c) { return c == '"' || c == '\''; });
    const auto varies = [&](const Variation &variation) { return variation.key == path; };
    if (std::any_of(ensemble.variations.begin(), ensemble.variations.end(), varies)) {
      found.push_back({Severity::error,
                       {origins.label_of_set(i), 0, 0},
                       fmt::format("'{}' varies in the ensemble", path),
                       "each member draws a value of its own, and none has the one that is set",
                       "leave the argument out, or change the distribution in [[ensemble.vary]]"});
    }
  }
  return found;
}

} // namespace gcpdda
