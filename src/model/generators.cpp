#include "model/generators.hpp"

#include <charconv>
#include <system_error>

namespace gcpdda {

namespace {

/// Row and place within it of a brick.
struct Place {
  std::int64_t row = 0;
  std::int64_t column = 0;
};

bool is_bonded(const BrickGenerator &wall) {
  return wall.bond > 0.0;
}

Place place_in_wall(const BrickGenerator &wall, std::int64_t index) {
  const std::int64_t odd_row = wall.columns + (is_bonded(wall) ? 1 : 0);
  const std::int64_t pair = index / (wall.columns + odd_row);
  const std::int64_t rest = index % (wall.columns + odd_row);
  return rest < wall.columns ? Place{2 * pair, rest} : Place{2 * pair + 1, rest - wall.columns};
}

/// Bricks of a pyramid below row r.
std::int64_t bricks_below(const BrickGenerator &pyramid, std::int64_t row) {
  return row * pyramid.rows - row * (row - 1) / 2;
}

Place place_in_pyramid(const BrickGenerator &pyramid, std::int64_t index) {
  // The last row that begins at or before the brick, by bisection: exact for any number of rows.
  std::int64_t low = 0;
  std::int64_t high = pyramid.rows - 1;
  while (low < high) {
    const std::int64_t middle = (low + high + 1) / 2;
    if (bricks_below(pyramid, middle) <= index) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return {low, index - bricks_below(pyramid, low)};
}

Place place_of(const BrickGenerator &generator, std::int64_t index) {
  return generator.kind == BrickGenerator::Kind::wall ? place_in_wall(generator, index)
                                                      : place_in_pyramid(generator, index);
}

/// Left and right end of a brick, from the left end of row 0. The ends are those of places in the row, not
/// one end and a width: without a gap neighbours share them bit for bit.
struct Span {
  double left = 0.0;
  double right = 0.0;
};

Span span_in_wall(const BrickGenerator &wall, const Place &place) {
  const double pitch = wall.block_size.x + wall.gap;
  const auto column = static_cast<double>(place.column);
  if (place.row % 2 == 0 || !is_bonded(wall)) {
    return {column * pitch, (column + 1.0) * pitch - wall.gap};
  }
  // The joints of the row lie bond widths right of those below; the ends are cut flush.
  const double first_joint = wall.bond * wall.block_size.x + 0.5 * wall.gap;
  const double end = static_cast<double>(wall.columns) * pitch - wall.gap;
  return {place.column == 0 ? 0.0 : first_joint + (column - 1.0) * pitch,
          place.column == wall.columns ? end : first_joint + column * pitch - wall.gap};
}

Span span_of(const BrickGenerator &generator, const Place &place) {
  if (generator.kind == BrickGenerator::Kind::wall) {
    return span_in_wall(generator, place);
  }
  const double pitch = generator.block_size.x + generator.gap;
  const double left = 0.5 * static_cast<double>(place.row) + static_cast<double>(place.column);
  return {left * pitch, (left + 1.0) * pitch - generator.gap};
}

std::string name_in(const BrickGenerator &generator, std::int64_t index) {
  const Place place = place_of(generator, index);
  return generator.name + "." + std::to_string(place.row) + "." + std::to_string(place.column);
}

/// The brick at a place, -1 where there is none.
std::int64_t brick_at(const BrickGenerator &generator, const Place &place) {
  if (place.row < 0 || place.row >= generator.rows || place.column < 0) {
    return -1;
  }
  const bool is_wall = generator.kind == BrickGenerator::Kind::wall;
  const std::int64_t cut = is_wall && is_bonded(generator) && place.row % 2 == 1 ? 1 : 0;
  const std::int64_t in_row = is_wall ? generator.columns + cut : generator.rows - place.row;
  if (place.column >= in_row) {
    return -1;
  }
  const std::int64_t below = is_wall
                                 ? place.row * generator.columns + (is_bonded(generator) ? place.row / 2 : 0)
                                 : bricks_below(generator, place.row);
  return below + place.column;
}

/// A number as std::to_string writes it, -1 for anything else.
std::int64_t to_number(std::string_view digits) {
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && std::to_string(number) == digits ? number : -1;
}

/// Number of the brick of that name, -1 where there is none.
std::int64_t find_brick(const BrickGenerator &generator, std::string_view name) {
  if (!name.starts_with(generator.name + ".")) {
    return -1;
  }
  name.remove_prefix(generator.name.size() + 1);
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) {
    return -1;
  }
  return brick_at(generator, {to_number(name.substr(0, dot)), to_number(name.substr(dot + 1))});
}

/// The generator that makes a block, with the block's number in it; null before and behind all of them.
struct Origin {
  const BrickGenerator *generator = nullptr;
  std::int64_t index = 0; ///< within the generator; within the file behind the last one
};

Origin origin_of(const Scene &scene, std::int64_t id) {
  Origin origin{nullptr, id - static_cast<std::int64_t>(scene.blocks.size())};
  for (const BrickGenerator &generator : scene.generators) {
    const std::int64_t count = num_blocks(generator);
    if (origin.index < count) {
      return {&generator, origin.index};
    }
    origin.index -= count;
  }
  return origin;
}

} // namespace

std::int64_t num_blocks(const BrickGenerator &generator) {
  if (generator.kind == BrickGenerator::Kind::pyramid) {
    return bricks_below(generator, generator.rows);
  }
  return generator.rows * generator.columns + (is_bonded(generator) ? generator.rows / 2 : 0);
}

SceneBlock make_block(const BrickGenerator &generator, std::int64_t index) {
  const Place place = place_of(generator, index);
  const Span span = span_of(generator, place);
  const double left = generator.origin.x + span.left;
  const double right = generator.origin.x + span.right;
  // From the row's number, not from the row below: rows share their heights bit for bit.
  const double bottom = generator.origin.y + static_cast<double>(place.row) * generator.block_size.y;
  const double top = generator.origin.y + static_cast<double>(place.row + 1) * generator.block_size.y;
  SceneBlock block;
  block.name = name_in(generator, index);
  block.material = generator.material;
  block.vertices = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
  block.where = generator.where;
  return block;
}

std::int64_t num_blocks(const Scene &scene) {
  auto count =
      static_cast<std::int64_t>(scene.blocks.size()) + scene.block_file.num_blocks + scene.num_region_blocks;
  for (const BrickGenerator &generator : scene.generators) {
    count += num_blocks(generator);
  }
  return count;
}

SceneBlock block_of(const Scene &scene, std::int64_t id) {
  if (id < static_cast<std::int64_t>(scene.blocks.size())) {
    return scene.blocks[static_cast<std::size_t>(id)];
  }
  const Origin origin = origin_of(scene, id);
  return make_block(*origin.generator, origin.index);
}

std::string block_name(const Scene &scene, std::int64_t id) {
  if (id < static_cast<std::int64_t>(scene.blocks.size())) {
    return scene.blocks[static_cast<std::size_t>(id)].name;
  }
  const Origin origin = origin_of(scene, id);
  return origin.generator != nullptr ? name_in(*origin.generator, origin.index) : "b" + std::to_string(id);
}

SourcePosition block_position(const Scene &scene, std::int64_t id) {
  if (id < static_cast<std::int64_t>(scene.blocks.size())) {
    return scene.blocks[static_cast<std::size_t>(id)].where;
  }
  const Origin origin = origin_of(scene, id);
  if (origin.generator != nullptr) {
    return origin.generator->where;
  }
  if (origin.index >= scene.block_file.num_blocks && scene.region.present()) {
    return scene.region.where;
  }
  return {scene.block_file.path + ", block " + std::to_string(origin.index), 0, 0};
}

std::int64_t find_generated_block(const Scene &scene, std::string_view name) {
  auto first = static_cast<std::int64_t>(scene.blocks.size());
  for (const BrickGenerator &generator : scene.generators) {
    const std::int64_t brick = find_brick(generator, name);
    if (brick >= 0) {
      return first + brick;
    }
    first += num_blocks(generator);
  }
  const bool has_file = !scene.block_file.path.empty();
  const bool has_region = scene.region.present();
  if ((!has_file && !has_region) || !name.starts_with('b')) {
    return -1;
  }
  const std::int64_t id = to_number(name.substr(1));
  const bool count_known =
      (!has_file || scene.block_file.num_blocks > 0) && (!has_region || scene.num_region_blocks > 0);
  return id >= first && (!count_known || id < num_blocks(scene)) ? id : -1;
}

} // namespace gcpdda
