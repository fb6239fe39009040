"""Curves over time, with the stages marked: histories, energy, bolts, liners; and the damping ratio over frequency."""

import matplotlib.pyplot as plt
import numpy as np

from . import style

COLOURS = ("#1f6f9f", "#d9822b", "#3a9a4b", "#b0332a", "#7b5aa6", "#8c6d31", "#20242a", "#d45087")


def mark_stages(axes, result, labels=True):
    """Lines where stages begin, their names above the axes. Stages that begin too close to each other share a label."""
    axes.set_xlim(0.0, max(axes.get_xlim()[1], 1e-12))
    stages = result.stages
    if not len(stages):
        return
    low, high = axes.get_xlim()
    places = []
    for name, begin in zip(stages["name"], stages["begin"]):
        if begin > low:
            axes.axvline(begin, color="#b8b8b8", lw=0.7, zorder=0)
        if places and begin - places[-1][0] < 0.06 * (high - low):
            places[-1][1].append(name)
        else:
            places.append((begin, [name]))
    if not labels:
        return
    top = axes.secondary_xaxis("top")
    top.set_xticks([begin for begin, _ in places], [",\n".join(names) for _, names in places], rotation=30, ha="left",
                   fontsize=7, linespacing=0.95)
    top.tick_params(length=2, pad=1)
    top.spines["top"].set_visible(False)


def curve_figure(rows=1, height=2.6):
    with plt.rc_context(style.PARAMETERS):
        figure, axes = plt.subplots(rows, 1, squeeze=False, figsize=(7.2, rows * height + 0.5), sharex=True,
                                    layout="constrained")
    axes[-1, 0].set_xlabel("time (s)")
    return figure, list(axes[:, 0])


def legend_beside(axes):
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=8)


# name: (label, unit, values of a history)
HISTORIES = {
    "displacement": ("displacement", "m",
                     lambda t: np.hypot(t["x[m]"] - t["x[m]"].iloc[0], t["y[m]"] - t["y[m]"].iloc[0])),
    "x": ("displacement in x", "m", lambda t: t["x[m]"] - t["x[m]"].iloc[0]),
    "y": ("displacement in y", "m", lambda t: t["y[m]"] - t["y[m]"].iloc[0]),
    "rotation": ("rotation", "°", lambda t: np.degrees(t["rotation[rad]"])),
    "speed": ("speed", "m/s", lambda t: np.hypot(t["vx[m/s]"], t["vy[m/s]"])),
    "sxx": ("stress xx", "Pa", lambda t: t["sxx[Pa]"]),
    "syy": ("stress yy", "Pa", lambda t: t["syy[Pa]"]),
    "sxy": ("stress xy", "Pa", lambda t: t["sxy[Pa]"]),
    "fx": ("contact force in x", "N/m", lambda t: t["fx[N/m]"]),
    "fy": ("contact force in y", "N/m", lambda t: t["fy[N/m]"]),
}


def draw_history(result, quantity, names=None):
    label, unit, values_of = HISTORIES[quantity]
    names = result.histories if names is None else [names] if isinstance(names, str) else list(names)
    curves = {}
    for name in names:
        table = result.history(name)
        try:
            if len(table):
                curves[name] = (table["time[s]"], values_of(table))
        except KeyError:
            pass  # a point has position and velocity alone
    if not curves:
        raise ValueError(f"no history of {quantity} with rows: monitored are {', '.join(names) or 'nothing'}; points "
                         "have no rotation, stress or force")
    largest = max(float(np.abs(values).max()) for _, values in curves.values())
    factor, unit = style.unit_prefix(unit, largest)
    figure, (axes,) = curve_figure()
    for colour, (name, (time, values)) in zip(COLOURS * (1 + len(curves) // len(COLOURS)), curves.items()):
        axes.plot(time, values * factor, color=colour, lw=1.2, label=name)
    axes.set_ylabel(f"{label} ({unit})")
    axes.margins(x=0.0)
    axes.axhline(0.0, color="#d8d8d8", lw=0.6, zorder=0)
    mark_stages(axes, result)
    legend_beside(axes)
    return figure


# name: (label, unit, values of the rows of a profile)
PROFILES = {
    "displacement": ("displacement", "m", lambda t: np.hypot(t["ux[m]"], t["uy[m]"])),
    "x": ("displacement in x", "m", lambda t: t["ux[m]"]),
    "y": ("displacement in y", "m", lambda t: t["uy[m]"]),
    "speed": HISTORIES["speed"], "sxx": HISTORIES["sxx"], "syy": HISTORIES["syy"], "sxy": HISTORIES["sxy"],
}


def draw_profile(result, name, quantity, times=None):
    """Points in no block interrupt a curve."""
    name = name if name is not None or not result.profiles else result.profiles[0]
    if name not in result.profiles:
        raise ValueError(f"no profile {name}: there are {', '.join(result.profiles) or 'none'}")
    label, unit, values_of = PROFILES[quantity]
    table = result.history(name)
    if not len(table):
        raise ValueError(f"the history of {name} has no rows")
    known = table["time[s]"].unique()
    if times is None:
        chosen = known[np.unique(np.linspace(0, len(known) - 1, 6).round().astype(int))[1 if len(known) > 1 else 0:]]
    else:
        chosen = [known[np.abs(known - time).argmin()] for time in np.atleast_1d(times)]
    values = values_of(table)
    factor, unit = style.unit_prefix(unit, float(np.abs(values).max()))
    distance = table["distance[m]"].astype(float)  # whole numbers alone are read as integers
    step = np.diff(np.sort(distance.unique())).min(initial=np.inf)
    figure, (axes,) = curve_figure()
    for colour, time in zip(plt.get_cmap("viridis")(np.linspace(0.85, 0.0, len(chosen))), chosen):
        rows = table["time[s]"] == time
        along, height = distance[rows].to_numpy(), values[rows].to_numpy() * factor
        gaps = np.flatnonzero(np.diff(along) > 1.5 * step) + 1
        axes.plot(np.insert(along, gaps, np.nan), np.insert(height, gaps, np.nan), color=colour, lw=1.2, marker=".",
                  ms=4, label=f"t = {time:.4g} s")
    axes.set(xlabel=f"distance along {name} (m)", ylabel=f"{label} ({unit})")
    axes.axhline(0.0, color="#d8d8d8", lw=0.6, zorder=0)
    legend_beside(axes)
    return figure


# column without unit: (label, sign, colour); what is stored or taken up adds to what the first row has
ENERGIES = {
    "kinetic": ("kinetic", "#d9822b"), "strain": ("strain of blocks", "#7b5aa6"), "contact": ("contacts", "#1f6f9f"),
    "gravity": ("gravity", "#8c6d31"), "support": ("bolts and liners", "#d45087"),
    "friction_loss": ("lost in friction", "#b0332a"),
    "damping_loss": ("lost in damping", "#e39a94"), "support_loss": ("lost in bolts and liners", "#e8a8c4"),
    "taken": ("taken by stages", "#9ec7de"), "boundary_work": ("work from outside", "#3a9a4b"),
    "residual": ("residual", "#20242a"),
}


def energy_parts(table):
    """Columns of energy.csv without units, the two of contacts together, each as its change since the first row; and
    what stages have taken, with the blocks that they remove and the motion that they stop, so that
    residual = stored + lost + taken - work from outside."""
    parts = {column.split("[")[0]: table[column] for column in table.columns if column.endswith("[J/m]")}
    parts["contact"] = parts.pop("contact_normal") + parts.pop("contact_stick")
    counted = sum(parts[name] - parts[name].iloc[0] for name in parts if name not in ("boundary_work", "residual"))
    parts["taken"] = parts["residual"] - counted + parts["boundary_work"]
    return {name: parts[name] - parts[name].iloc[0] for name in ENERGIES if name in parts}


def draw_energy(result):
    table = result.energy
    if not len(table):
        raise ValueError(f"the history of energies in {result.path} has no rows")
    time = table["time[s]"]
    parts = energy_parts(table)
    largest = max(float(np.abs(values).max()) for values in parts.values())
    parts = {name: values for name, values in parts.items() if name == "residual"
             or np.abs(values).max() > 1e-6 * largest}
    factor, unit = style.unit_prefix("J/m", largest)
    figure, (upper, lower) = curve_figure(2, 2.5)
    for name, values in parts.items():
        label, colour = ENERGIES[name]
        upper.plot(time, values * factor, color=colour, lw=1.2, ls=(0, (4, 2)) if name == "residual" else "-",
                   label=label)
    upper.set_ylabel(f"change of energy ({unit})")
    upper.axhline(0.0, color="#d8d8d8", lw=0.6, zorder=0)
    for column, label, colour in (("unbalanced_ratio[-]", "unbalanced ratio (-)", "#1f6f9f"),
                                  ("max_speed[m/s]", "largest speed (m/s)", "#d9822b")):
        values = table[column].where(table[column] > 0.0)
        if values.notna().any():
            lower.semilogy(time, values, color=colour, lw=1.0, label=label)
    lower.set_ylabel("rest")
    lower.grid(axis="y", color="#e8e8e8", lw=0.5)
    for axes in (upper, lower):
        axes.margins(x=0.0)
        mark_stages(axes, result, labels=axes is upper)
        legend_beside(axes)
    return figure


def draw_bolts(result):
    """Tension of every bolt over time."""
    table = result.bolts
    if not len(table):
        raise ValueError(f"no history of bolts in {result.path}")
    factor, unit = style.unit_prefix("N", float(table["axial[N]"].abs().max()))
    figure, (axes,) = curve_figure()
    bolts = list(table.groupby("bolt", sort=False))
    colours = COLOURS if len(bolts) <= len(COLOURS) else [plt.get_cmap("turbo")(x)
                                                          for x in np.linspace(0.05, 0.95, len(bolts))]
    for colour, (name, rows) in zip(colours, bolts):
        marker = "o" if len(rows) == 1 else None  # a single row, of a bolt that was put in at the end, has no line
        axes.plot(rows["time[s]"], rows["axial[N]"] * factor, color=colour, lw=1.0, marker=marker, ms=3, label=name,
                  clip_on=marker is None)
    axes.set_ylabel(f"tension ({unit})")
    axes.margins(x=0.0)
    mark_stages(axes, result)
    if len(bolts) <= 20:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=7, ncol=1 + (len(bolts) > 12))
    return figure


def draw_liners(result):
    """Largest thrust, moment and share of the strength of every liner over time."""
    table = result.liners
    if not len(table):
        raise ValueError(f"no history of liners in {result.path}")
    figure, panels = curve_figure(3, 1.8)
    columns = (("compression[N/m]", "thrust", "N/m"), ("moment[N]", "moment", "N m/m"),
               ("strength_used[-]", "strength used", "-"))
    for axes, (column, label, unit) in zip(panels, columns):
        factor, shown = style.unit_prefix(unit, float(table[column].abs().max()))
        for k, (name, rows) in enumerate(table.groupby("liner", sort=False)):
            axes.plot(rows["time[s]"], rows[column] * factor, color=COLOURS[k % len(COLOURS)], lw=1.2, marker=".", ms=3,
                      label=name)
        axes.set_ylabel(f"{label} ({shown})")
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.0)
        mark_stages(axes, result, labels=axes is panels[0])
    legend_beside(panels[0])
    return figure


def draw_rayleigh(result):
    """Damping ratio over frequency of run.rayleigh as it is at the end of the run, and the shares of alpha and beta."""
    rayleigh = result.table_at("run", np.inf).get("rayleigh")
    if rayleigh is None:
        raise ValueError(f"{result.path / 'scene.toml'} has no run.rayleigh")
    ratio, least = float(rayleigh["ratio"]), float(rayleigh["frequency"])
    f = np.geomspace(0.1 * least, 10.0 * least, 400)
    by_mass, by_stiffness = 0.5 * ratio * least / f, 0.5 * ratio * f / least
    with plt.rc_context(style.PARAMETERS):
        figure, axes = plt.subplots(figsize=(5.2, 3.4), layout="constrained")
    axes.plot(f, by_mass + by_stiffness, color=style.EDGE, lw=1.4, label="both")
    axes.plot(f, by_mass, color="#2f7fd6", lw=1.0, ls=(0, (5, 2)), label="alpha M")
    axes.plot(f, by_stiffness, color="#b0332a", lw=1.0, ls=(0, (5, 2)), label="beta K")
    axes.plot([least], [ratio], "o", color=style.EDGE, ms=4)
    axes.annotate(f"{ratio:g} at {least:g} Hz", (least, ratio), xytext=(0, 8), textcoords="offset points", ha="center")
    axes.set(xscale="log", xlabel="frequency (Hz)", ylabel="damping ratio", xlim=(f[0], f[-1]), ylim=(0.0, None))
    axes.set_title(f"alpha = {2.0 * np.pi * least * ratio:.4g} 1/s, beta = {ratio / (2.0 * np.pi * least):.4g} s",
                   fontsize=9)
    axes.legend(frameon=False)
    return figure
