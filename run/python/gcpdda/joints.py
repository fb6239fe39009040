"""Joints between blocks: where they are, how they have moved, and how much of their strength is used."""

from typing import NamedTuple

import numpy as np

STATES = ("open", "stick", "slip", "bond")  # by the number of a contact's state; 0 is no contact
LEAST_LENGTH = 1e-2  # of a joint, in sizes of the smaller block


class Joints(NamedTuple):
    """Where edges of two blocks lie on each other: numbers of the two blocks, and the ends (n, 2, 2) in m, in the order
    of the edge of the first block, whose inside is to the left."""

    blocks: np.ndarray
    lines: np.ndarray


def find_joints(frame, gap=5e-3):
    """The joints of a frame: pairs of edges of opposite direction, not farther from each other than `gap` times the
    size of the smaller of their blocks, which is the root of its area, and of any block between them. Fixed blocks have
    no joints with each other."""
    points, offsets = frame.points, frame.offsets
    if not len(frame.ids):
        return Joints(np.empty((0, 2), dtype=int), np.empty((0, 2, 2)))
    counts = np.diff(offsets)
    owner = np.repeat(np.arange(len(counts)), counts)
    following = np.arange(1, len(points) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    begin, end = points.copy(), points[following]
    clockwise = _signed_areas(points, points[following], offsets) < 0.0
    turned = clockwise[owner]
    begin[turned], end[turned] = end[turned], points[turned]
    size = np.sqrt(frame.areas)[owner]

    # The boxes of two edges that lie on each other meet where each is larger by the tolerance of its own block.
    reach = gap * size[:, None]
    low, high = np.minimum(begin, end) - reach, np.maximum(begin, end) + reach
    order = np.argsort(low[:, 0], kind="stable")
    begin, end, owner, size, low, high = begin[order], end[order], owner[order], size[order], low[order], high[order]
    fixed = frame.fixed[owner]
    along = end - begin
    length = np.hypot(*along.T)
    along = along / np.maximum(length, 1e-300)[:, None]
    last = np.searchsorted(low[:, 0], high[:, 0], side="right")
    edges, parts, distances = [], [], []
    for first in range(len(begin)):
        near = np.arange(first + 1, last[first])
        near = near[(low[near, 1] <= high[first, 1]) & (high[near, 1] >= low[first, 1]) & (owner[near] != owner[first])]
        near = near[(along[near] @ along[first] < -0.9999) & ~(fixed[near] & fixed[first])]
        if not len(near):
            continue
        t, n = along[first], np.array([-along[first, 1], along[first, 0]])
        s = np.stack([(end[near] - begin[first]) @ t, (begin[near] - begin[first]) @ t])
        middle = 0.5 * (begin[near] + end[near]) - begin[first]
        # The part where the two edges are beside each other, and their distance in its middle.
        s0, s1 = np.maximum(s[0], 0.0), np.minimum(s[1], length[first])
        slope = -(along[near] @ n)
        distance = np.abs(middle @ n + slope * (0.5 * (s0 + s1) - middle @ t))
        smaller = np.minimum(size[near], size[first])
        for k in np.flatnonzero((s1 - s0 > LEAST_LENGTH * smaller) & (distance <= gap * smaller)):
            edges.append((first, near[k]))
            parts.append((s0[k], s1[k]))
            distances.append(distance[k])
    edges, parts = np.array(edges, dtype=int).reshape(-1, 2), np.array(parts).reshape(-1, 2)
    first = edges[:, 0]
    lines = begin[first, None] + parts[:, :, None] * along[first, None]
    on_second = np.einsum("nki,ni->nk", lines - begin[edges[:, 1], None], along[edges[:, 1]])[:, ::-1]
    places = np.concatenate([parts, on_second])
    kept = ~_has_blocks_between(edges.T.ravel(), places, np.array(distances), size[edges].min(axis=1), gap)
    pairs, lines = frame.ids[owner[edges[kept]]], lines[kept]
    swapped = pairs[:, 0] > pairs[:, 1]
    pairs[swapped], lines[swapped] = pairs[swapped][:, ::-1], lines[swapped][:, ::-1]
    return Joints(pairs, lines)


def _has_blocks_between(edge, places, distance, size, gap):
    """True for each pair of edges that is farther apart than a smaller block on the same part of one of them allows.
    The first half of `edge` and `places`, its part in m along the edge, is of the first edges, the second half of the
    others; `size` is that of the smaller block."""
    pair = np.tile(np.arange(len(distance)), 2)
    order = np.lexsort((places[:, 0], edge))
    edge, (begin, end), pair = edge[order], places[order].T, pair[order]
    between = np.zeros(len(distance), dtype=bool)
    # Parts of one edge are sorted by their beginnings: row k is compared with row k + step while the two overlap.
    ahead, step = np.arange(len(edge)), 0
    while len(ahead):
        step += 1
        ahead = ahead[ahead + step < len(edge)]
        ahead = ahead[(edge[ahead + step] == edge[ahead]) & (begin[ahead + step] < end[ahead])]
        common = np.minimum(end[ahead], end[ahead + step]) - begin[ahead + step]
        for one, other in ((pair[ahead], pair[ahead + step]), (pair[ahead + step], pair[ahead])):
            between[one[(common > LEAST_LENGTH * size[other]) & (distance[one] > gap * size[other])]] = True
    return between


def _signed_areas(p, q, offsets):
    origin = np.repeat(p[offsets[:-1]], np.diff(offsets), axis=0)
    p, q = p - origin, q - origin
    return 0.5 * np.add.reduceat(p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1], offsets[:-1])


def affine_maps(old, new):
    """Affine maps of blocks from one frame to another, which vertices give exactly: blocks are rigid or have one
    strain. Returns rows in `new` (-1 for a block that is missing there) by row in `old`, matrices, centres in `old`,
    centres in `new`."""
    row_of = {block: row for row, block in enumerate(new.ids.tolist())}
    rows = np.array([row_of.get(block, -1) for block in old.ids.tolist()], dtype=int)
    there = np.flatnonzero(rows >= 0)
    matrices, centres_old, centres_new = np.zeros((len(rows), 2, 2)), np.zeros((len(rows), 2)), np.zeros((len(rows), 2))
    if not len(there):
        return rows, matrices, centres_old, centres_new
    counts = np.diff(old.offsets)[there]
    begins = np.concatenate(([0], np.cumsum(counts)))[:-1]
    p = np.concatenate([old.points[old.offsets[k]:old.offsets[k + 1]] for k in there])
    q = np.concatenate([new.points[new.offsets[k]:new.offsets[k + 1]] for k in rows[there]])
    centre_p = np.add.reduceat(p, begins) / counts[:, None]
    centre_q = np.add.reduceat(q, begins) / counts[:, None]
    p, q = p - np.repeat(centre_p, counts, axis=0), q - np.repeat(centre_q, counts, axis=0)
    moments = np.add.reduceat(p[:, :, None] * p[:, None, :], begins)
    mixed = np.add.reduceat(q[:, :, None] * p[:, None, :], begins)
    matrices[there] = mixed @ np.linalg.inv(moments)
    centres_old[there], centres_new[there] = centre_p, centre_q
    return rows, matrices, centres_old, centres_new


def track(joints, first, frame):
    """Joints of the first frame in another one: their lines on the edges of the two blocks, openings and shear
    displacements, and which of the joints are left, whose two blocks are both there."""
    rows, matrices, old, new = affine_maps(first, frame)
    position = np.full(int(first.ids.max(initial=-1)) + 1, -1)
    position[first.ids] = np.arange(len(first.ids))
    a, b = position[joints.blocks[:, 0]], position[joints.blocks[:, 1]]
    there = np.flatnonzero((rows[a] >= 0) & (rows[b] >= 0))

    def moved(block):
        local = joints.lines[there] - old[block, None]
        return new[block, None] + np.einsum("nij,nkj->nki", matrices[block], local)

    on_a, on_b = moved(a[there]), moved(b[there])
    lines = 0.5 * (on_a + on_b)
    tangent = lines[:, 1] - lines[:, 0]
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-300)[:, None]
    apart = (on_b - on_a).mean(axis=1)
    # The first block lies to the left of the line, the second one to the right.
    opening = apart[:, 0] * tangent[:, 1] - apart[:, 1] * tangent[:, 0]
    return np.stack([on_a, on_b], axis=1), opening, np.einsum("ni,ni->n", apart, tangent), there


def strength_laws(result, at):
    """The laws of a scene as they are at a frame or a time in s, with what stages have set: {name: keys}, keys of
    default filled in."""
    laws = result.table_at("joint", at)
    default = laws.get("default", {})
    inherited = {key: value for key, value in default.items() if key != "materials"}
    # The law of rollers that the program adds has neither friction nor cohesion.
    added = {name: {} for name in result.joint_names if name not in laws}
    return {name: inherited | keys for name, keys in laws.items()} | added


def strength_used(frame):
    """|T|/(N tan phi + c l) of each contact region: 1 where it slips. A bond has its peak strength and carries the
    shear of its joint, while the region on its edges carries what presses on them: both have the value of N and T
    together. Every other contact has its residual strength. 0 where there is neither force nor strength, infinite where
    a force meets none."""
    data = frame._contact_data
    touching, bond, share = pressed_bonds(data)
    normal, shear = data["normal_force"].copy(), np.abs(data["shear_force"])
    np.add.at(normal, bond, share * data["normal_force"][touching])
    strength = _strengths(frame, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        used = shear / strength
    used[shear == 0.0] = 0.0
    np.maximum.at(used, touching, used[bond])
    return used


def pressed_bonds(data):
    """Rows of contact regions that press on the edges of a bond, rows of these bonds, and the share of the region's
    length that lies beside the bond."""
    import pandas
    is_bond = data["state"] == STATES.index("bond")
    pairs = np.sort(data["blocks"], axis=1)
    rows = pandas.DataFrame({"a": pairs[:, 0], "b": pairs[:, 1], "row": np.arange(len(pairs))})
    both = rows[~is_bond].merge(rows[is_bond], on=["a", "b"], suffixes=("", "_bond"))
    touching, bond = both["row"].to_numpy(), both["row_bond"].to_numpy()
    along = data["lines"][bond, 1] - data["lines"][bond, 0]
    length = np.hypot(*along.T)
    along = along / np.maximum(length, 1e-300)[:, None]
    ends = data["lines"][touching] - data["lines"][bond, :1]
    s = np.einsum("nki,ni->nk", ends, along)
    aside = along[:, None, 0] * ends[..., 1] - along[:, None, 1] * ends[..., 0]
    beside = np.minimum(s.max(axis=1), length) - np.maximum(s.min(axis=1), 0.0)
    # Edges with a bond lie on each other up to 2 % of their length where stress in the rock presses them together.
    lie_on_it = (beside > 0.0) & (np.abs(aside).max(axis=1) < 0.05 * length)
    share = beside / np.maximum(np.ptp(s, axis=1), 1e-300)
    return touching[lie_on_it], bond[lie_on_it], share[lie_on_it]


def _strengths(frame, normal):
    """N tan phi + c l of each contact region in N/m, with the normal forces N in N/m."""
    data = frame._contact_data
    laws = strength_laws(frame.result, frame)
    factor, families = frame.result.weakened
    length = np.hypot(*(data["lines"][:, 1] - data["lines"][:, 0]).T)
    strength = np.zeros(len(normal))
    for number, name in enumerate(frame.result.joint_names):
        for bond in (False, True):
            of = (data["joint"] == number) & ((data["state"] == STATES.index("bond")) == bond)
            phi, c = _friction(laws[name], bond, normal[of], length[of])
            strength[of] = np.maximum(normal[of] * np.tan(np.radians(phi)) + c * length[of], 0.0)
            strength[of] /= factor if name in families else 1.0
    return strength


def _friction(law, bond, normal, length):
    """Friction angles in degrees and cohesion in Pa of contacts or bonds of a law."""
    angle, cohesion = law.get("friction_angle_deg", 0.0), law.get("cohesion", 0.0)
    if law.get("law") == "barton-bandis":
        stress = np.maximum(normal, 1e-12) / np.maximum(length, 1e-12)
        roughness = law["jrc"] * np.log10(np.maximum(law["jcs"] / stress, 1.0))
        return np.minimum(law.get("residual_friction_angle_deg", angle) + roughness, 70.0), cohesion
    if not bond and {"tension", "residual_cohesion", "residual_friction_angle_deg"} & law.keys():
        return law.get("residual_friction_angle_deg", angle), law.get("residual_cohesion", 0.0)
    return angle, cohesion
