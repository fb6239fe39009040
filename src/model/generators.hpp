#pragma once

// Where the blocks of a scene come from. BlockId is the order of the scene: inline blocks, then generators,
// then the file, then the region. Generated blocks are pure functions of their number, so a rank makes its
// range and no more.

#include "gcpdda/model/scene.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace gcpdda {

/// Bricks of a wall: even rows (from 0, the lowest) hold `columns` whole bricks; odd rows begin with a piece
/// of bond widths and end with one of the rest, so that both ends of the wall are straight and no brick
/// overhangs. With bond 0 all rows are equal. A pyramid has rows - r bricks in row r, each row shifted by
/// half a brick and half a gap. `gap` lies between neighbours of a row, never below a brick.
std::int64_t num_blocks(const BrickGenerator &generator);

/// Brick number `index` of a generator, rows from below, bricks from the left.
SceneBlock make_block(const BrickGenerator &generator, std::int64_t index);

/// Blocks of the scene, all sources together; those of file and region as far as they are known.
std::int64_t num_blocks(const Scene &scene);

/// Block `id` of the scene file or a generator.
SceneBlock block_of(const Scene &scene, std::int64_t id);

/// Name of any block: the scene's; "<generator>.<row>.<column>"; "b<id>" for one of the file or region.
std::string block_name(const Scene &scene, std::int64_t id);

/// Where a person finds any block; for a block of the file, the file and its number there; for one of the
/// region, the region.
SourcePosition block_position(const Scene &scene, std::int64_t id);

/// Id of the block of that name among those of generators, file and region, -1 where none has it. As long as
/// the counts of file and region are not known, "b<id>" is taken for one of theirs whenever the id lies
/// behind all others.
std::int64_t find_generated_block(const Scene &scene, std::string_view name);

} // namespace gcpdda
