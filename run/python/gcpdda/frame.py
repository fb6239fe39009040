"""One output time of a run: blocks, contacts, joints, bolts and liners as arrays and tables."""

import functools

import numpy as np

from .joints import STATES, track

KINDS = ("fixed", "rigid", "deformable")
BOLT_STATES = ("elastic", "yielded", "broken")
LINER_NUMBERS = ("axial_force", "shear_force", "moment_begin", "moment_end", "extension", "slide", "turn", "thickness",
                 "strength_used")


def polygon_facts(points, offsets):
    """Areas (positive) and centroids of polygons that follow each other in `points`."""
    counts = np.diff(offsets)
    first = np.repeat(points[offsets[:-1]], counts, axis=0)  # near the origin nothing cancels
    following = np.arange(1, len(points) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    p, q = points - first, points[following] - first
    cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    twice = np.add.reduceat(cross, offsets[:-1])
    moments = np.add.reduceat((p + q) * cross[:, None], offsets[:-1])
    return np.abs(0.5 * twice), points[offsets[:-1]] + moments / (3.0 * twice[:, None])


class Frame:
    """All blocks at one output time.

    number, time    of the frame; time in s
    ids             numbers of the blocks, in the order of all arrays; excavated blocks are missing
    points, offsets corners in m: block k has points[offsets[k]:offsets[k + 1]]
    values(NAME)    a dataset of the frame by name: displacement, rotation, velocity, stress, contact_force, kind,
                    material
    blocks, contacts, bolts, liners, joints     tables, one row each
    """

    def __init__(self, result, number, path):
        self.result, self.number, self.path = result, number, path

    @functools.cached_property
    def _data(self):
        import h5py
        with h5py.File(self.path, "r") as file:
            grid = file["VTKHDF"]
            data = {name: grid["CellData"][name][:] for name in grid["CellData"]}
            data |= {"time": float(grid.attrs["time"]), "points": grid["Points"][:, :2], "offsets": grid["Offsets"][:]}
        return data

    @property
    def time(self):
        return self._data["time"]

    @property
    def points(self):
        return self._data["points"]

    @property
    def offsets(self):
        return self._data["offsets"]

    @property
    def ids(self):
        return self._data["block"]

    @functools.cached_property
    def fixed(self):
        """True for fixed blocks."""
        return self._data["kind"] == 0

    def values(self, name):
        return self._data[name]

    @functools.cached_property
    def polygons(self):
        """Corners of each block, a list of arrays."""
        return np.split(self.points, self.offsets[1:-1])[:len(self.ids)]  # none where no block is left

    @functools.cached_property
    def _facts(self):
        return polygon_facts(self.points, self.offsets)

    @property
    def areas(self):
        return self._facts[0]

    @property
    def centroids(self):
        return self._facts[1]

    @functools.cached_property
    def blocks(self):
        """One row a block, by number: name, material, kind, centroid (x, y), area, displacement and its parts, ..."""
        import pandas
        data = self._data
        columns = {"name": self.result.names_of(self.ids), "material": self._named("material", "material"),
                   "kind": np.array(KINDS)[data["kind"]], "x": self.centroids[:, 0], "y": self.centroids[:, 1],
                   "area": self.areas, "displacement": np.hypot(*data["displacement"][:, :2].T),
                   "ux": data["displacement"][:, 0], "uy": data["displacement"][:, 1], "rotation": data["rotation"]}
        columns |= dict(zip(("vx", "vy", "omega"), data["velocity"].T))
        columns |= dict(zip(("sxx", "syy", "sxy"), data["stress"].T))
        columns |= dict(zip(("fx", "fy"), data["contact_force"].T))
        return pandas.DataFrame(columns, index=pandas.Index(self.ids, name="block"))

    @functools.cached_property
    def _contact_data(self):
        import h5py
        self.expect_contacts()
        with h5py.File(self._contact_path, "r") as file:
            cells = file["VTKHDF/CellData"]
            data = {name: cells[name][:] for name in cells}
            data["lines"] = file["VTKHDF/Points"][:, :2].reshape(-1, 2, 2)
        return data

    @property
    def _contact_path(self):
        return self._path_of("contacts")

    @property
    def has_contacts(self):
        return self._contact_path.exists()

    def expect_contacts(self):
        """Raises FileNotFoundError where there are none."""
        if self.has_contacts:
            return
        reason = ("the file has been removed, or the run was ended before the frame was complete; compute the folder "
                  "again, or take another frame" if self._writes_contacts
                  else "contacts, and states of joints, are written unless the scene has output.contacts = false")
        raise FileNotFoundError(f"{self._contact_path} does not exist: {reason}")

    @property
    def _writes_contacts(self):
        return self.result.scene.get("output", {}).get("contacts", True)

    @property
    def has_all_files(self):
        """True where the files of contacts, bolts and liners are there that the scene asks for. Kinds that the frame
        before has none of do not count."""
        if not (self.result.path / "scene.toml").exists():
            return True
        kinds = [*self.result.supports, *(["contacts"] if self._writes_contacts else [])]
        before = Frame(self.result, self.number - 1, self.path.with_name(f"frame_{self.number - 1:06}.hdf"))
        if before.path.exists():
            kinds = [kind for kind in kinds if before._path_of(kind).exists()]
        return all(self._path_of(kind).exists() for kind in kinds)

    def _path_of(self, kind):
        return self.path.with_name(self.path.name.replace("frame_", f"{kind}_"))

    @property
    def contact_lines(self):
        """Ends of each contact region, (n, 2, 2) in m."""
        return self._contact_data["lines"]

    @functools.cached_property
    def contacts(self):
        """One row a contact region: the two blocks, joint law, state, forces in N/m, overlap and accumulated slip in
        m, its ends and its length. A bond has state "bond", the shear force of its joint, and minus its tension as
        normal force; what presses on its edges is in a row with state "stick"."""
        import pandas
        data = self._contact_data
        (x0, y0), (x1, y1) = (data["lines"][:, end].T for end in (0, 1))
        return pandas.DataFrame({
            "block_a": data["blocks"][:, 0], "block_b": data["blocks"][:, 1], "joint": self._contact_joints(),
            "state": np.array(["", "stick", "slip", "bond"])[data["state"]], "normal_force": data["normal_force"],
            "shear_force": data["shear_force"], "overlap": data["overlap"], "slip": data["slip"],
            "x0": x0, "y0": y0, "x1": x1, "y1": y1, "length": np.hypot(x1 - x0, y1 - y0)})

    def _contact_joints(self):
        return np.array(self.result.joint_names, dtype=object)[self._contact_data["joint"]]

    def _named(self, name, table):
        return np.array(list(self.result.scene[table]), dtype=object)[self._data[name]]

    @functools.cached_property
    def contact_forces(self):
        """Force of each contact region on block_a in N/m, (n, 2); on block_b it is the opposite."""
        data = self._contact_data
        along = data["lines"][:, 1] - data["lines"][:, 0]
        length = np.hypot(*along.T)
        tangent = np.divide(along, length[:, None], out=np.zeros_like(along), where=length[:, None] > 0.0)
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        return data["normal_force"][:, None] * normal - data["shear_force"][:, None] * tangent

    @functools.cached_property
    def _tracked(self):
        return track(self.result.joint_traces, self.result.start, self)

    @property
    def joint_lines(self):
        """Lines of each joint of `joints` on the edges of its two blocks, (n, 2, 2, 2) in m: joint, block, end,
        coordinate."""
        return self._tracked[0]

    @functools.cached_property
    def joints(self):
        """One row a joint of the first frame, that is where edges of two blocks lay on each other (of a trial of
        `gcpdda fos` in its settled state): the blocks, the ends of its middle line in m, opening and shear displacement
        since then in m, and with contacts the state: stick, slip or bond; broken where a bond was; unloaded where edges
        lie on each other without force; else open."""
        import pandas
        lines, opening, shear, there = self._tracked
        blocks, middle = self.result.joint_traces.blocks[there], lines.mean(axis=1)
        table = pandas.DataFrame({"block_a": blocks[:, 0], "block_b": blocks[:, 1], "x0": middle[:, 0, 0],
                                  "y0": middle[:, 0, 1], "x1": middle[:, 1, 0], "y1": middle[:, 1, 1],
                                  "opening": opening, "shear_displacement": shear})
        if self.has_contacts:
            table["state"] = self._joint_states(table)
        return table

    def _joint_states(self, table):
        """The largest state of the contacts of each pair; broken where that of the first frame was a bond. Trials have
        contacts also where output.contacts = false leaves the settled state without."""
        start, now = self.result.start, self._pair_states
        before = start._pair_states if start.has_contacts else {}
        rows = np.searchsorted(self.ids, table[["block_a", "block_b"]].to_numpy())
        closed = 1e-6 * np.sqrt(self.areas)[rows].min(axis=1)
        states = []
        for a, b, is_closed in zip(table["block_a"], table["block_b"], table["opening"] < closed):
            state = now.get((a, b), 0)
            if before.get((a, b), 0) == 3 and state != 3:
                states.append("broken")
            else:
                states.append("unloaded" if state == 0 and is_closed else STATES[state])
        return states

    @functools.cached_property
    def _pair_states(self):
        states = {}
        pairs = np.sort(self._contact_data["blocks"], axis=1).tolist()
        for pair, state in zip(map(tuple, pairs), self._contact_data["state"].tolist()):
            states[pair] = max(state, states.get(pair, 0))
        return states

    @functools.cached_property
    def bolt_lines(self):
        """Corners of each line of a bolt, a list of arrays: one where a bolt crosses a joint, or all of a cable."""
        return self._bolt_data[0]

    @functools.cached_property
    def _bolt_data(self):
        import h5py
        path = self._path_of("bolts")
        if not path.exists():
            return [], {name: np.empty(0) for name in ("axial_force", "shear_force", "extension", "slide")} | {
                name: np.empty(0, dtype=int) for name in ("bolt", "support", "state")}
        with h5py.File(path, "r") as file:
            grid = file["VTKHDF"]
            lines = np.split(grid["Points"][:, :2], grid["Offsets"][1:-1]) if len(grid["Offsets"]) > 1 else []
            return lines, {name: grid["CellData"][name][:] for name in grid["CellData"]}

    @functools.cached_property
    def bolts(self):
        """One row for each line of `bolt_lines`: bolt, support, state, forces of one bolt in N, extension and slide
        in m."""
        import pandas
        table = pandas.DataFrame(self._bolt_data[1])
        table["support"] = [list(self.result.scene["support"])[k] for k in table["support"]]
        table["state"] = np.array(BOLT_STATES, dtype=object)[table["state"].to_numpy(dtype=int)]
        return table[["bolt", "support", "state", "axial_force", "shear_force", "extension", "slide"]]

    @functools.cached_property
    def liner_lines(self):
        """Both nodes of each element of a liner, (n, 2, 2), in m; the rock is on the right of the way between them."""
        return self._liner_data[0]

    @functools.cached_property
    def _liner_data(self):
        import h5py
        path = self._path_of("liners")
        if not path.exists():
            return np.empty((0, 2, 2)), {name: np.empty(0) for name in LINER_NUMBERS} | {
                name: np.empty(0, dtype=int) for name in ("liner", "support", "state", "cracked")}
        with h5py.File(path, "r") as file:
            grid = file["VTKHDF"]
            return grid["Points"][:, :2].reshape(-1, 2, 2), {name: grid["CellData"][name][:]
                                                             for name in grid["CellData"]}

    @functools.cached_property
    def liners(self):
        """One row for each of `liner_lines`: liner, support, state, cracked, forces per metre of tunnel: axial_force
        (tension positive) and shear_force in N/m, moments at both nodes in N (positive: the side of the rock in
        tension); extension and slide in m, turn in rad, thickness in m, strength_used from 0 to 1."""
        import pandas
        table = pandas.DataFrame(self._liner_data[1])
        names = [liner.get("name", f"liner{k}") for k, liner in enumerate(self.result.scene.get("liner", []))]
        table["liner"] = [names[k] for k in table["liner"]]
        table["support"] = [list(self.result.scene["support"])[k] for k in table["support"]]
        table["state"] = np.array(BOLT_STATES, dtype=object)[table["state"].to_numpy(dtype=int)]
        table["cracked"] = table["cracked"].to_numpy() > 0
        return table[["liner", "support", "state", "cracked", *LINER_NUMBERS]]

    def __repr__(self):
        return f"<Frame {self.number} of {self.result.path.name}, t = {self.time:g} s, {len(self.ids)} blocks>"
