"""Scenes built in code and written as TOML."""

import copy
import math
import numbers
import pathlib
import re
import tomllib

from .result import path_parts

# Keys whose values are paths from the folder of the scene file.
_PATHS = {("blocks", "file"), ("joint_map", "file"), ("earthquake", "record")}


def read_toml(path):
    """The tables of a scene file, which is UTF-8 with or without a byte order mark."""
    try:
        return tomllib.loads(pathlib.Path(path).read_text(encoding="utf-8-sig"))
    except ValueError as error:  # those of tomllib and of text that is no UTF-8 are such errors
        raise tomllib.TOMLDecodeError(f"{path}: {error}") from error


def toml_value(value):
    """A value as TOML; tables become inline tables."""
    if hasattr(value, "tolist"):  # numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        value = float(value)
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (str, pathlib.PurePath)):
        escaped = str(value).replace("\\", "\\\\").replace('"', '\\"')
        return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda c: f"\\u{ord(c[0]):04x}", escaped) + '"'
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {toml_value(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    raise TypeError(f"a scene holds numbers, texts, booleans, lists and tables, not {type(value).__name__}: {value!r}")


def _key(key):
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_value(key)


def _is_table_list(value):
    return isinstance(value, list) and len(value) > 0 and all(isinstance(entry, dict) for entry in value)


def _table_text(header, table):
    return header + "\n" + "".join(f"{_key(key)} = {toml_value(value)}\n" for key, value in table.items())


class Scene:
    """A scene: keys of [run] as arguments, everything else by the methods below, in any order.

        scene = gcpdda.Scene(duration=4.0)
        scene.material("rock", density=2600)
        scene.joint("default", normal_stiffness=1e9, friction_angle_deg=25)
        scene.block("ground", [[-5, -1], [5, -1], [5, 0], [-5, 0]], material="rock", fixed=True)
        scene.block("cube", [[-1, 0], [1, 0], [1, 2], [-1, 2]], material="rock", velocity=[1, 0, 0])
        result = gcpdda.run(scene, out="results/cube")

    `tables` holds everything as nested dictionaries, as tomllib would read it. Keys and values are those of
    run/scene_keys.md; the program checks them, `gcpdda.inspect(scene)` does so without a run.
    """

    def __init__(self, name="scene", folder=".", **run):
        self.name, self.folder, self.file = name, pathlib.Path(folder), None
        self.tables = {"run": dict(run)}

    @classmethod
    def read(cls, path):
        """The scene of a TOML file. Comments are not kept."""
        path = pathlib.Path(path)
        scene = cls(path.stem, path.parent)
        scene.file = path
        scene.tables = read_toml(path)
        return scene

    def copy(self):
        return copy.deepcopy(self)

    def table(self, name, /, **keys):
        """Adds keys to the table [name], such as output or region.slope, and returns it."""
        return self._add(name.split("."), keys)

    def _add(self, path, keys):
        table = self.tables
        for part in path:
            table = table.setdefault(part, {})
        table.update(keys)
        return table

    def add(self, name, /, **keys):
        """Appends a table [[name]], such as joint_set, wall, bolt or ensemble.vary, and returns it."""
        *path, last = name.split(".")
        self._add(path, {}).setdefault(last, []).append(keys)
        return keys

    def material(self, name, /, **keys):
        return self._add(["material", name], keys)

    def joint(self, name="default", /, **keys):
        return self._add(["joint", name], keys)

    def block(self, name, vertices, material, **keys):
        return self.add("block", name=name, material=material, vertices=vertices, **keys)

    def stage(self, name, kind, /, **keys):
        return self.add("stage", name=name, kind=kind, **keys)

    def monitor(self, name=None, point=None, block=None, along=None, points=None):
        """Records the history of a block, of a point that follows the block that holds it, or of `points` such points
        along a line."""
        entry = {"name": name, "point": point, "block": block, "along": along, "points": points}
        return self.add("monitor", **{key: value for key, value in entry.items() if value is not None})

    def toml(self):
        """The scene as text."""
        parts = []
        for name, value in self.tables.items():
            if _is_table_list(value):
                parts += [_table_text(f"[[{_key(name)}]]", entry) for entry in value]
            elif isinstance(value, dict) and value and all(isinstance(entry, dict) for entry in value.values()):
                parts += [_table_text(f"[{_key(name)}.{_key(key)}]", entry) for key, entry in value.items()]
            elif isinstance(value, dict):
                parts.append(_table_text(f"[{_key(name)}]", value))
            else:
                parts.insert(0, f"{_key(name)} = {toml_value(value)}\n")
        return "\n".join(parts)

    def is_read_from(self, path):
        """Whether a file is the one that the scene was read from."""
        return self.file is not None and pathlib.Path(path).exists() and self.file.exists() and self.file.samefile(path)

    def values_to_set(self, values):
        """Values by path for --set, {"earthquake.record": "record.csv"}: files in them are found from any place."""
        found = {}
        for path, value in values.items():
            *parts, last = path_parts(path) or (path,)
            table = {last: copy.deepcopy(value)}
            tables = table
            for part in reversed(parts):
                tables = {part: tables}
            self._complete_paths(tables)
            found[path] = table[last]
        return found

    def _complete_paths(self, tables):
        """Replaces paths that start from the folder of the scene by those from the root."""
        for name, key in _PATHS:
            found = tables.get(name, [])
            for table in found if isinstance(found, list) else [found]:
                if isinstance(table, dict) and isinstance(table.get(key), (str, pathlib.PurePath)):
                    table[key] = str((self.folder / table[key]).resolve())

    def write(self, path):
        """Writes the scene as TOML and returns the path. Files it names are found from the new place, too."""
        path = pathlib.Path(path)
        moved = self.copy()
        self._complete_paths(moved.tables)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(moved.toml(), encoding="utf-8")
        return path
