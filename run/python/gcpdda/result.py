"""Result folders as tables. Everything is read when it is asked for, also while the run goes on."""

import copy
import functools
import io
import json
import pathlib
import re
import tomllib

import numpy as np

from .frame import Frame
from .joints import find_joints

# The first line of the scene of a run whose strengths `gcpdda fos` divides.
WEAKENED = re.compile(r"# (?:a trial of|settled by) gcpdda fos: strengths as below divided by (\S+)$")

STAGE_COLUMNS = ["name", "kind", "verdict", "begin", "end", "steps", "contact_steps", "unbalanced_ratio", "kinetic",
                 "moved", "removed", "loose"]
# Lines of run.log.
STAGE_LINE = re.compile(r"stage '(.*)' (?:(\w+) )?at t = (\S+) s(?:, (\d+) blocks removed|"
                        r" after (\d+) steps: unbalanced (\S+), largest motion (\S+) of a block's size)")
RESTART_LINE = re.compile(r"restart from .*: t = (\S+) s, step")


def _damaged(path, reason):
    return ValueError(f"{path} is damaged: {reason}; compute its folder again, or restore the file from a copy")


def read_csv(path, words=None):
    """A history as a table with the columns of the file. A row that is just being written is left out.

    words   names of the columns that hold words; those of all others are numbers, else the file is refused. Columns
            are taken as they are if not given.
    """
    import pandas
    try:
        text = path.read_text()
        table = pandas.read_csv(io.StringIO(text[: text.rfind("\n") + 1]), float_precision="round_trip")
    except ValueError as error:  # those of pandas and of text that is no UTF-8 are such errors
        raise _damaged(path, error) from error
    for name in [] if words is None or table.empty else table.columns.difference(words):
        if not pandas.api.types.is_numeric_dtype(table[name]):
            raise _damaged(path, f"a value in its column {name} is no number")
    return table


def read_json(path):
    """The dictionary in a JSON file of the program."""
    try:
        found = json.loads(path.read_text())
    except ValueError as error:
        raise _damaged(path, error) from error
    if not isinstance(found, dict):
        raise _damaged(path, "it holds no JSON object")
    return found


def read_scene(path, tables=("run", "material", "joint")):
    """The dictionary in a scene file of the program, in which these tables may not be missing."""
    try:
        found = tomllib.loads(path.read_text())
    except ValueError as error:
        raise _damaged(path, error) from error
    for name in tables:
        if name not in found:
            raise _damaged(path, f"the table [{name}] is missing")
    return found


def path_parts(path):
    """The names of a path such as joint."rock.hard".cohesion, in which those with dots are quoted."""
    return tuple("".join(found) for found in re.findall(r"\"([^\"]*)\"|'([^']*)'|([^.\s\"']+)", path))


def _is_same_time(a, b):
    return abs(a - b) <= 1e-9 * max(a, 1.0)


def _takes_no_time(stage):
    """True for a row of `Result.stages` that has ended when it began, as excavations do."""
    return stage["verdict"] != "goes on" and _is_same_time(stage["begin"], stage["end"])


def _is_later(frame):
    """True for a frame that has the time of the frame before it: stages that take no time lie between the two."""
    frames = frame.result.frames
    place = [one.number for one in frames].index(frame.number)
    return place > 0 and _is_same_time(frames[place - 1].time, frame.time)


def trial_folder(factor):
    """Name of the folder of a trial of `gcpdda fos`."""
    return f"F{factor:.9g}"


def settled_folder(search):
    """Folder of the settled state of a search: in its own, or what --settled named; None where neither is there."""
    found = search / "fos.json"
    named = read_json(found)["settled"]["directory"] if found.exists() else search
    return next((path for path in (search / "settled", pathlib.Path(named)) if (path / "frames").is_dir()), None)


class Folder:
    """What result folders have in common."""

    def __init__(self, path):
        self.path = pathlib.Path(path)

    def _json(self, name):
        path = self.path / name
        return read_json(path) if path.exists() else None

    def __repr__(self):
        return f"<{type(self).__name__} {self.path}>"


class Result(Folder):
    """The result folder of a run.

    frames, frame(WHICH)       `Frame`s: a number, "first", "last", or the one at or before a time: at(TIME)
    start                      the frame from which joints and motions count
    times                      of the frames, in s
    histories, history(NAME)   names of the monitors; the table of one. energy, bolts, liners: tables of the same kind
    profiles                   names of the monitored lines
    summary                    summary.json as a dictionary, None while the run goes on; verdict comes from it
    stages                     table of the stages, from run.log while the run goes on
    scene, log                 the resolved scene as a dictionary; what the program has printed
    plot                       pictures: result.plot.field("stress", out="stress.png")
    """

    @functools.cached_property
    def scene(self):
        return read_scene(self.path / "scene.toml")

    @functools.cached_property
    def joint_names(self):
        """Names of the joint laws by their number in the files: default, then the others in the order of the scene, and
        that of rollers, which the program adds where the scene has none."""
        names = ["default"] + [name for name in self.scene["joint"] if name != "default"]
        return names if not self.rollers or "roller" in names else [*names, "roller"]

    @property
    def rollers(self):
        """Names of the fixed blocks along the rollers of the region."""
        return [f"roller.{side}" for side in self.scene.get("region", {}).get("roller", [])]

    @property
    def summary(self):
        return self._json("summary.json")

    def to_vtkhdf(self, out=None, kind="blocks"):
        """All frames in one temporal VTKHDF file, of blocks, contacts, bolts or liners; returns its path."""
        from . import vtkhdf
        return vtkhdf.write(self.path, out, kind)

    def to_pyvista(self, which="last", kind="blocks"):
        """A frame as a grid of pyvista, which has to be installed."""
        import pyvista
        from .vtkhdf import KINDS
        number = self.frame(which).number
        return pyvista.read(self.path / "frames" / f"{KINDS[kind]}_{number:06}.hdf")

    @property
    def verdict(self):
        """completed, settled, failed, undecided or stopped; None while the run goes on."""
        summary = self.summary
        return summary["verdict"] if summary else None

    @property
    def log(self):
        path = self.path / "run.log"
        return path.read_text() if path.exists() else ""

    @property
    def stages(self):
        """One row a stage that has ended: name, kind, verdict, begin and end in s, steps, ... Empty without stages.
        While the run goes on, or where it was killed, the last row is the stage in which it is: "goes on"."""
        import pandas
        summary = self.summary
        entries = self._stages_of_log() if summary is None else summary.get("stages", [])
        table = pandas.DataFrame(entries, columns=["name", "verdict", "time"] if not entries else None)
        table = table.rename(columns={"time": "end"})
        kinds = {name: stage["kind"] for name, stage in self._stage_tables.items()}
        table["kind"] = [kinds.get(name, "") for name in table["name"]]
        table["begin"] = [0.0, *table["end"][:-1]][:len(table)]
        return table.reindex(columns=STAGE_COLUMNS)

    @property
    def _stage_tables(self):
        """Tables of the scene for its stages, by name."""
        return {stage.get("name", f"stage{k}"): stage for k, stage in enumerate(self.scene.get("stage", []))}

    def _stages_of_log(self):
        """What summary.json will have about the stages that have ended, and the stage that goes on."""
        rows = read_csv(self.path / "history" / "energy.csv")["time[s]"].to_numpy() if self.reached else np.zeros(1)
        ended = {}
        for line in self.log.splitlines():
            if restart := RESTART_LINE.match(line):
                latest = (1 + 1e-8) * float(restart[1])
                ended = {name: entry for name, entry in ended.items() if entry["time"] <= latest}
            if not (stage := STAGE_LINE.match(line)):
                continue
            name, verdict, time, removed, steps, unbalanced, moved = stage.groups()
            ended.pop(name, None)
            # The log has nine digits; the row of the histories that ends the stage has all of them.
            row = rows[np.abs(rows - float(time)).argmin()]
            ended[name] = {"name": name, "verdict": verdict or "done", "steps": int(steps or 0),
                           "time": float(row) if abs(row - float(time)) <= 1e-8 * float(time) else float(time),
                           "unbalanced_ratio": float(unbalanced or 0.0), "moved": float(moved or 0.0),
                           "removed": int(removed or 0)}
        going_on = next((name for name in self._stage_tables if name not in ended), None)
        last = [] if going_on is None else [{"name": going_on, "verdict": "goes on", "time": self.reached}]
        return [*ended.values(), *last]

    def set_by_stages(self, at):
        """Values of the scene that stages which began before a frame have set, by the parts of their paths:
        {("joint", "default", "cohesion"): value}. A time in s stands for the last frame that is not later."""
        time = at.time if isinstance(at, Frame) else at
        tables, values = self._stage_tables, {}
        for stage in self.stages.to_dict("records"):
            begin = stage["begin"]
            begun = begin == 0.0 or begin < time
            if begin > 0.0 and _is_same_time(begin, time):
                begun = _takes_no_time(stage) and _is_later(at if isinstance(at, Frame) else self.at(at))
            if begun:
                settings = tables.get(stage["name"], {}).get("set", {})
                values |= {path_parts(path): value for path, value in settings.items()}
        return values

    def table_at(self, name, at):
        """The table [name] of the scene as it is at a frame or a time in s, with what stages have set; empty without
        one."""
        table = copy.deepcopy(self.scene.get(name, {}))
        for parts, value in self.set_by_stages(at).items():
            if parts[0] == name and len(parts) == 2:
                table[parts[1]] = value
            elif parts[0] == name and len(parts) == 3:
                table.setdefault(parts[1], {})[parts[2]] = value
        return table

    @property
    def frames(self):
        """All frames that are complete. While a run goes on there are more of them each time."""
        known = self.__dict__.setdefault("_frames", {})
        has_ended = (self.path / "summary.json").exists()  # before the files are looked for: then all of them are there
        found = {int(path.stem.split("_")[1]): path for path in (self.path / "frames").glob("frame_*.hdf")}
        for number in found.keys() - known.keys():
            frame = Frame(self, number, found[number])
            if has_ended or number < max(found) or frame.has_all_files:  # files are written frame by frame
                known[number] = frame
        return [known[number] for number in sorted(known)]

    def frame(self, which="last"):
        frames = self.frames
        if not frames:
            raise FileNotFoundError(f"no frames in {self.path}")
        if which in ("first", "last"):
            return frames[0 if which == "first" else -1]
        if isinstance(which, int) and -len(frames) <= which < 0:
            return frames[which]
        by_number = {frame.number: frame for frame in frames}
        if which not in by_number:
            raise KeyError(f"no frame {which}: there are {min(by_number)} to {max(by_number)}, first, last, all")
        return by_number[which]

    @functools.cached_property
    def start(self):
        """The frame from which joints and motions count: the first one; of a trial of `gcpdda fos`, which has a frame
        of its end alone, the last one of the settled state."""
        folder = self.path.resolve()
        trial = folder.parent if folder.name == "confirm" else folder
        if trial.parent.name != "trials" or not self.weakened[1]:
            return self.frame("first")
        settled = settled_folder(trial.parent.parent)
        if settled is None:
            raise FileNotFoundError(f"the settled state that {self.path} begins with is not found: it is in 'settled' "
                                    f"of {trial.parent.parent}, or where fos.json there says")
        return Result(settled).frame("last")

    def at(self, time):
        """The last frame that is not later than a time."""
        latest = time + 1e-9 * max(time, 1.0)
        early = [frame for frame in self.frames if frame.time <= latest]
        if not early and self.start.time > latest:
            raise ValueError(f"no frame of {self.path} is at or before t = {time:g} s")
        return early[-1] if early else self.start

    def before(self, stage):
        """The last frame before a stage."""
        place = self._place_of(stage)
        return self.at(0.0) if place == 0 else self.at_end_of(self.stages["name"][place - 1])

    def at_end_of(self, stage):
        """The frame at the end of a stage. Where the last stages take no time, the frame of the last one has the time
        of the frame before them. A stage between the two has the frame with the blocks that the stage leaves."""
        place, stages = self._place_of(stage), self.stages
        end = float(stages["end"][place])
        alike = [frame for frame in self.frames if _is_same_time(frame.time, end)]
        if len(alike) < 2:
            return self.at(end)
        after = stages[place + 1:].to_dict("records")
        if _takes_no_time(stages.iloc[place]) and not any(map(_takes_no_time, after[:1])):
            return alike[-1]
        left = len(self.frame("first").ids) - stages["removed"].fillna(0)[:place + 1].sum()
        return next((frame for frame in alike if len(frame.ids) == left), alike[0])

    def _place_of(self, stage):
        names = list(self.stages["name"])
        if stage not in names:
            raise KeyError(f"no stage {stage}: there are {', '.join(names) or 'none'}")
        return names.index(stage)

    @property
    def times(self):
        return np.array([frame.time for frame in self.frames])

    @property
    def reached(self):
        """Simulated time of the newest row of the histories in s, 0 before there is one."""
        path = self.path / "history" / "energy.csv"
        if not path.exists():
            return 0.0
        with open(path, "rb") as file:
            file.seek(max(0, path.stat().st_size - 4096))
            rows = file.read().decode(errors="replace").split("\n")[:-1]
        try:
            return float(rows[-1].split(",")[0]) if rows else 0.0
        except ValueError:  # the header
            return 0.0

    @property
    def histories(self):
        """Names of the monitored blocks and points."""
        return [name for name in self._monitors if name not in self.profiles]

    @property
    def profiles(self):
        """Names of the monitored lines; history(NAME) is the table of one, a row for each time and point."""
        return [name for name in self._monitors if self._is_profile(name)]

    @property
    def _monitors(self):
        names = sorted(path.stem for path in (self.path / "history").glob("*.csv"))
        return [name for name in names if name not in ("energy", *(self.supports if names else ()))]

    @functools.cached_property
    def supports(self):
        """Which of "bolts" and "liners" the scene has. Where it has none, a monitor may have that name."""
        tables = {"bolts": ("bolt", "bolt_pattern"), "liners": ("liner",)}
        if not (self.path / "scene.toml").exists():
            return list(tables)
        return [name for name, keys in tables.items() if any(self.scene.get(key) for key in keys)]

    def _is_profile(self, name):
        with open(self.path / "history" / f"{name}.csv") as file:
            return file.readline().startswith("time[s],distance[m],")

    def history(self, name):
        path = self.path / "history" / f"{name}.csv"
        if not path.exists():
            raise KeyError(f"no history {name}: there are {', '.join(self._monitors) or 'none'}")
        return read_csv(path, words=[])

    @property
    def energy(self):
        """Energies over time; empty before the first row."""
        import pandas
        path = self.path / "history" / "energy.csv"
        return read_csv(path, words=[]) if path.exists() else pandas.DataFrame()

    @property
    def bolts(self):
        """Forces of bolts over time; empty without bolts."""
        return self._support_table("bolts")

    @property
    def liners(self):
        """Largest forces of liners over time; empty without liners."""
        return self._support_table("liners")

    def _support_table(self, name):
        import pandas
        path = self.path / "history" / f"{name}.csv"
        return read_csv(path) if path.exists() and name in self.supports else pandas.DataFrame()

    @functools.cached_property
    def joint_traces(self):
        """Joints of the frame `start`."""
        return find_joints(self.start)

    @functools.cached_property
    def weakened(self):
        """Of a trial of `gcpdda fos`, and of the state it begins with: the factor that divides strengths, and the joint
        laws that are weakened."""
        with open(self.path / "scene.toml") as file:
            said = WEAKENED.match(file.readline())
        if not said:
            return 1.0, []
        return float(said[1]), self.scene.get("fos", {}).get("families") or self.joint_names

    @functools.cached_property
    def _names(self):
        """Names of inline blocks, rollers and generated blocks; those after them are b<number>."""
        names = [block.get("name", f"b{k}") for k, block in enumerate(self.scene.get("block", []))] + self.rollers
        # Generators in the order of the file, in which walls and pyramids may alternate.
        headings = re.findall(r"^\[\[(wall|pyramid)\]\]$", (self.path / "scene.toml").read_text(), re.M)
        for place, kind in enumerate(headings):
            k = headings[:place].count(kind)
            table = self.scene[kind][k]
            for row in range(table["rows"]):
                if kind == "pyramid":
                    columns = table["rows"] - row
                else:
                    columns = table["columns"] + (row % 2 if table.get("bond", 0.5) > 0 else 0)
                names += [f"{table.get('name', f'{kind}{k}')}.{row}.{column}" for column in range(columns)]
        return names

    def names_of(self, ids):
        return [self._names[k] if k < len(self._names) else f"b{k}" for k in np.asarray(ids).tolist()]

    @functools.cached_property
    def plot(self):
        from .plot import Plots
        return Plots(self)


class _Outcome(Folder):
    """A folder whose summary is written when the computation ends."""

    @property
    def summary(self):
        return self._json(self._summary_file)

    @property
    def outcome(self):
        """`summary`, or FileNotFoundError, which says what to do, where the computation has not ended."""
        self._expect_end()
        return self.summary

    def _expect_end(self):
        if not (self.path / self._summary_file).exists():
            raise FileNotFoundError(self._why_it_is_missing())


class Safety(_Outcome):
    """The result folder of `gcpdda fos`: factor, holds, fails, bound; trials and blocks as tables. Until the search has
    ended there is only `settled` and what trials have written: `summary` is None, and the others say what to do."""

    _summary_file = "fos.json"

    def _why_it_is_missing(self):
        if not is_search(self.path):
            return f"{self.path} is not the folder of a search: it holds no fos.json"
        words = (f"{self.path} holds a search for the factor of safety that has not ended: fos.json is missing; wait "
                 f"for its end, or where it was stopped repeat gcpdda fos SCENE.toml --out {self.path} --overwrite")
        settled = self.path / "settled"
        if Result(settled).verdict in ("settled", "completed"):
            words += f", or begin with its settled state: another folder with --out, and --settled {settled}"
        return words

    @property
    def factor(self):
        return self.outcome["factor"]

    @property
    def holds(self):
        """The largest factor with which the blocks hold."""
        return self.outcome["holds"]

    @property
    def fails(self):
        """The smallest factor with which they fail."""
        return self.outcome["fails"]

    @property
    def bound(self):
        """The upper bound of `gcpdda fos --bound`, None where that was not asked for or limit analysis finds none."""
        return self.outcome["bound"]

    @property
    def trials(self):
        self._expect_end()
        return read_csv(self.path / "fos_trials.csv")

    @property
    def blocks(self):
        """Motion of every block in the trial with the smallest factor that fails."""
        self._expect_end()
        return read_csv(self.path / "fos_blocks.csv")

    @property
    def settled(self):
        """The run that trials begin with: in this folder, or that of another search, which --settled named."""
        return Result(settled_folder(self.path) or self.path / "settled")

    def trial(self, factor):
        """The run of the trial with that factor."""
        return Result(self.path / "trials" / trial_folder(factor))

    @property
    def mechanism(self):
        """The run of the trial with the smallest factor that fails, None where no trial fails."""
        failed = [trial["factor"] for trial in self.outcome["trials"] if trial["verdict"] == "failed"]
        return self.trial(min(failed)) if failed else None


class Ensemble(_Outcome):
    """The result folder of `gcpdda ensemble`: summary, None until the members are computed, and a table with a row for
    each member."""

    _summary_file = "ensemble.json"

    def _why_it_is_missing(self):
        if not (self.path / "ensemble.toml").exists():
            return f"{self.path} is not the folder of an ensemble: it holds no ensemble.json"
        return (f"{self.path} holds an ensemble that has not ended: ensemble.json is missing; wait for its end, or "
                "repeat its call of gcpdda ensemble, which computes the missing members")

    @property
    def members(self):
        self._expect_end()
        return read_csv(self.path / "ensemble_members.csv", words=["outcome", "message"])

    @property
    def probability_of_failure(self):
        return self.outcome["probability_of_failure"]


def is_search(path):
    """True for the folder of a search for the factor of safety, also of one that has not ended."""
    return any((path / name).exists() for name in ("fos.json", "settled", "trials"))


def open_folder(path):
    """The `Result`, `Safety` or `Ensemble` in a folder, by what it holds."""
    path = pathlib.Path(path)
    if (path / "fos.json").exists():
        return Safety(path)
    if (path / "ensemble.json").exists():
        return Ensemble(path)
    if (path / "scene.toml").exists() or (path / "frames").is_dir():
        return Result(path)
    if is_search(path):
        return Safety(path)
    if (path / "ensemble.toml").exists():
        return Ensemble(path)
    raise FileNotFoundError(f"{path} is not a result folder: it holds no scene.toml, fos.json or ensemble.json")
