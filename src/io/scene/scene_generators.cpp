#include "io/scene/scene_generators.hpp"

#include "geometry/point_text.hpp"
#include "io/scene/scene_blocks.hpp"
#include "io/scene/scene_materials.hpp"
#include "io/scene/scene_outline.hpp"
#include "model/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace gcpdda::scene_text {

namespace {

using Kind = BrickGenerator::Kind;

/// Narrowest cut brick, and narrowest bearing of a brick on those below it, in brick widths.
constexpr double least_share = 0.1;
/// A tenth of a brick that the scene's numbers mean exactly must not fail for their rounding.
constexpr double rounding_of_share = 1e-9;

struct Found {
  Kind kind;
  Section section;
  std::string name;
};

class GeneratorReader {
public:
  GeneratorReader(const SceneSource &source, Materials &materials, Names &names, Fidelity of_run)
      : source_(source), materials_(&materials), names_(&names), of_run_(of_run) {}

  /// Nothing where it cannot be built.
  std::optional<BrickGenerator> read(const Found &found) {
    const Section &section = found.section;
    names_->add(section, section.label(), found.name);
    const std::int32_t material = materials_->find(section);
    if (of_run_ == Fidelity::deformable && section.given("material") != nullptr) {
      materials_->expect_elastic(material, section.label(), *section.given("material"));
    }
    BrickGenerator generator;
    generator.kind = found.kind;
    generator.name = found.name;
    generator.material = std::max(0, material);
    generator.where = source_.faults.origins().position(section.source());
    section.read("origin", generator.origin);
    section.read("rows", generator.rows);
    section.read("columns", generator.columns);
    section.read("block_size", generator.block_size);
    section.read("bond", generator.bond);
    section.read("gap", generator.gap);
    const bool is_wall = found.kind == Kind::wall;
    for (const char *key : {"origin", "rows", "columns", "block_size"}) {
      if (section.sound(key) == nullptr && (is_wall || std::string_view(key) != "columns")) {
        return std::nullopt;
      }
    }
    if (!section.known("bond") || !section.known("gap")) {
      return std::nullopt;
    }
    if (!(is_wall ? check_cut_bricks(section, generator) : check_bearing(section, generator)) ||
        !check_size(section, generator)) {
      return std::nullopt;
    }
    return generator;
  }

private:
  bool fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
    return false;
  }

  bool check_cut_bricks(const Section &section, const BrickGenerator &wall) {
    const double width = wall.block_size.x;
    const double left = wall.bond * width - 0.5 * wall.gap;
    const double right = (1.0 - wall.bond) * width - 0.5 * wall.gap;
    const double narrowest = std::min(left, right);
    if (wall.bond == 0.0 || wall.rows == 1 || narrowest >= (least_share - rounding_of_share) * width) {
      return true;
    }
    const toml::node *node = section.given(section.given("bond") != nullptr ? "bond" : "gap");
    return fault(node->source(),
                 narrowest > 0.0 ? fmt::format("{} would be cut into bricks {:g} m wide at its {} end",
                                               section.label(), narrowest, left < right ? "left" : "right")
                                 : fmt::format("{} has no room for the bricks at its {} end", section.label(),
                                               left < right ? "left" : "right"),
                 fmt::format("bond {:g} and gap {:g} m leave less than a tenth of the width {:g} m",
                             wall.bond, wall.gap, width),
                 "use a smaller gap, or a bond nearer to 0.5, or 0");
  }

  bool check_bearing(const Section &section, const BrickGenerator &pyramid) {
    const double width = pyramid.block_size.x;
    const double bearing = 0.5 * (width - pyramid.gap);
    if (pyramid.rows == 1 || bearing >= (least_share - rounding_of_share) * width) {
      return true;
    }
    return fault(section.given("gap")->source(),
                 fmt::format("the gap of {} is {:g} m", section.label(), pyramid.gap),
                 fmt::format("bricks {:g} m wide would rest on less than a tenth of their width", width),
                 fmt::format("use a gap of at most {:g} m", 0.8 * width));
  }

  bool check_size(const Section &section, const BrickGenerator &generator) {
    const double columns =
        static_cast<double>(generator.kind == Kind::wall ? generator.columns : generator.rows);
    const Vec2 low = generator.origin;
    const Vec2 high{low.x + columns * (generator.block_size.x + generator.gap) - generator.gap,
                    low.y + static_cast<double>(generator.rows) * generator.block_size.y};
    const double largest = std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
    if (largest > largest_coordinate) {
      return fault(section.source(), fmt::format("{} reaches to {}", section.label(), point_text(high, 12)),
                   fmt::format("coordinates are at most {:.12g}", largest_coordinate),
                   "use fewer or smaller bricks");
    }
    const double smallest = std::min(least_share * generator.block_size.x, generator.block_size.y);
    if (smallest <= coordinate_rounding(largest)) {
      return fault(section.given("block_size")->source(),
                   fmt::format("the bricks of {} are lost in rounding", section.label()),
                   fmt::format("its coordinates reach {:g} and hold 16 digits", largest),
                   "use larger bricks or an origin nearer to [0, 0]");
    }
    return true;
  }

  SceneSource source_;
  Materials *materials_;
  Names *names_;
  Fidelity of_run_;
};

/// Walls and pyramids as they follow each other in the file.
std::vector<Found> find_generators(const SceneSource &source) {
  std::vector<Found> found;
  for (const auto &[kind, list] : {std::pair(Kind::wall, "wall"), std::pair(Kind::pyramid, "pyramid")}) {
    const std::vector<Section> sections = listed_sections(source.root, list, source.faulty);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const toml::node &node = (*source.root[list].as_array())[i];
      found.push_back({kind, sections[i], name_of_element(list, node, i)});
    }
  }
  const Origins &origins = source.faults.origins();
  std::stable_sort(found.begin(), found.end(), [&](const Found &a, const Found &b) {
    return origins.order(a.section.source()) < origins.order(b.section.source());
  });
  return found;
}

void check_brick_names(const SceneSource &source, const Scene &scene) {
  const std::vector<Section> sections = listed_sections(source.root, "block", source.faulty);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::string &name = scene.blocks[i].name;
    if (find_generated_block(scene, name) >= 0) {
      const toml::node *given = sections[i].sound("name");
      source.faults.add(given->source(), fmt::format("block '{}' has the name of a brick", name),
                        "those of walls and pyramids are named <wall>.<row>.<column>", "choose another name");
    }
  }
}

} // namespace

std::vector<BrickGenerator> read_generators(const SceneSource &source, Materials &materials, Names &names,
                                            Fidelity of_run, const std::vector<SceneBlock> &blocks) {
  GeneratorReader reader(source, materials, names, of_run);
  Scene scene;
  scene.blocks = blocks;
  for (const Found &found : find_generators(source)) {
    auto generator = reader.read(found);
    if (!generator) {
      continue;
    }
    const std::int64_t room = most_blocks_in_all - num_blocks(scene);
    if (num_blocks(*generator) > room) {
      source.faults.add(found.section.source(),
                        fmt::format("{} makes {} blocks", found.section.label(), num_blocks(*generator)),
                        fmt::format("a scene has at most {} in all", most_blocks_in_all),
                        "use fewer rows or columns");
      continue;
    }
    scene.generators.push_back(std::move(*generator));
  }
  check_brick_names(source, scene);
  return scene.generators;
}

BlockFile read_block_file_table(const SceneSource &source, Materials &materials, Fidelity of_run,
                                const std::string &scene_file) {
  BlockFile file;
  const Section blocks = section(source.root, "blocks", source.faulty);
  if (const auto path = blocks.text("file")) {
    file.path = (std::filesystem::path(scene_file).parent_path() / *path).string();
    file.where = source.faults.origins().position(blocks.given("file")->source());
    if (of_run == Fidelity::deformable) {
      materials.expect_all_elastic();
    }
  }
  return file;
}

} // namespace gcpdda::scene_text
