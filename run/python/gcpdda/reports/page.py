"""An HTML page in one file: headings, tables, pictures, a player."""

import base64
import html
import math

STYLE = """
:root { --ink: #20242a; --quiet: #5d6672; --line: #dfe3e8; --blue: #1f6f9f;
  --good: #2e7d4f; --bad: #b0332a; --open: #a66a00 }
* { box-sizing: border-box }
body { margin: 0; color: var(--ink); background: #fff; font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif }
header, main, nav { max-width: 1060px; margin: 0 auto; padding: 0 24px }
header { padding-top: 28px }
h1 { font-size: 27px; margin: 0 }
h2 { font-size: 20px; margin: 40px 0 8px; padding-top: 8px; border-top: 1px solid var(--line) }
h3 { font-size: 16px; margin: 24px 0 6px }
nav { position: sticky; top: 0; background: #fffffff2; border-bottom: 1px solid var(--line);
  padding-top: 8px; padding-bottom: 8px; z-index: 2 }
nav a { margin-right: 14px; color: var(--blue); text-decoration: none; white-space: nowrap }
nav a:hover { text-decoration: underline }
section { scroll-margin-top: 60px }
.verdict { font-size: 17px; margin: 10px 0 4px; padding: 10px 14px; border-left: 5px solid var(--quiet);
  background: #f5f7f9 }
.good { border-color: var(--good) } .bad { border-color: var(--bad) } .open { border-color: var(--open) }
.cards { display: flex; flex-wrap: wrap; gap: 10px; margin: 14px 0 }
.card { border: 1px solid var(--line); border-radius: 6px; padding: 8px 14px; min-width: 120px }
.card b { display: block; font-size: 18px } .card span { color: var(--quiet); font-size: 13px }
.scroll { overflow-x: auto } table { border-collapse: collapse; margin: 8px 0; font-size: 14px }
th, td { border-bottom: 1px solid var(--line); padding: 4px 12px 4px 0; text-align: left; vertical-align: top }
th { color: var(--quiet); font-weight: 600 }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
figure { margin: 14px 0 } figure img, .player img { max-width: 100%; height: auto; display: block }
figcaption, .note { color: var(--quiet); font-size: 14px; max-width: 80ch }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(430px, 1fr)); gap: 0 20px }
.player { border: 1px solid var(--line); border-radius: 6px; padding: 12px; margin: 14px 0;
  display: inline-block; max-width: 100% }
.player .controls { display: flex; gap: 10px; align-items: center; margin-top: 8px }
.player input { flex: 1; min-width: 60px }
.player button { font: inherit; min-width: 70px; padding: 2px 10px }
.player output { min-width: 110px; text-align: right }
pre { background: #f5f7f9; padding: 10px 14px; overflow-x: auto; font-size: 13px; line-height: 1.4; max-height: 520px }
code { font-size: 13px; overflow-wrap: anywhere }
ul { padding-left: 20px }
footer { color: var(--quiet); margin: 40px 0 28px; font-size: 13px }
@media print {
  nav, .player .controls { display: none }
  pre { max-height: none } h2 { break-after: avoid } figure { break-inside: avoid }
}
"""

SCRIPT = """
for (const player of document.querySelectorAll(".player")) {
  const frames = JSON.parse(player.querySelector("script").textContent);
  const [image, button, slider, label] = ["img", "button", "input", "output"].map(name => player.querySelector(name));
  let timer = null;
  const show = () => {
    image.src = "data:image/png;base64," + frames[slider.value].image;
    label.textContent = "t = " + frames[slider.value].time + " s";
  };
  const stop = () => { clearInterval(timer); timer = null; button.textContent = "Play"; };
  const step = () => {
    if (+slider.value >= frames.length - 1) { stop(); return; }
    slider.value = +slider.value + 1;
    show();
  };
  button.addEventListener("click", () => {
    if (timer) { stop(); return; }
    if (+slider.value >= frames.length - 1) slider.value = 0;
    show();
    button.textContent = "Pause";
    timer = setInterval(step, Math.max(60, Math.min(400, 8000 / frames.length)));
  });
  slider.addEventListener("input", () => { stop(); show(); });
  show();
}
"""


def text_of(value):
    """A value as a reader wants it: numbers short, lists with commas."""
    if value is None or isinstance(value, float) and math.isnan(value):
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        if 1e4 <= abs(value) < 1e7:
            return f"{value:,.0f}"
        return f"{value:.0f}" if value == round(value) and abs(value) < 1e4 else f"{value:.4g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} = {text_of(entry)}" for key, entry in value.items())
    if isinstance(value, (list, tuple)):
        if len(value) > 12:
            return f"{len(value)} entries"
        return ", ".join(f"({text_of(entry)})" if isinstance(entry, (list, tuple, dict)) else text_of(entry)
                         for entry in value)
    return str(value)


class Page:
    """Sections, each with a heading in the navigation, that are filled one after the other."""

    def __init__(self, title):
        self.title, self.head, self.parts, self.places = title, [], [], []

    def section(self, name):
        anchor = name.lower().replace(" ", "-")
        self.places.append((anchor, name))
        self.parts.append(f'<section id="{anchor}"><h2>{html.escape(name)}</h2></section>')

    def heading(self, text):
        self.parts.append(f"<h3>{html.escape(text)}</h3>")

    def text(self, text, kind="p"):
        self.parts.append(f"<{kind}>{html.escape(text)}</{kind}>" if kind != "note"
                          else f'<p class="note">{html.escape(text)}</p>')

    def verdict(self, text, kind):
        """The sentence at the top; kind is good, bad or open."""
        self.head.append(f'<p class="verdict {kind}">{html.escape(text)}</p>')

    def cards(self, values):
        """Numbers at the top: {what it is: text}."""
        cards = "".join(f'<div class="card"><b>{html.escape(value)}</b><span>{html.escape(name)}</span></div>'
                        for name, value in values.items())
        self.head.append(f'<div class="cards">{cards}</div>')

    def table(self, rows, columns=None):
        """Rows are dictionaries or a pandas table; columns {key: heading}, in this order."""
        rows = rows.to_dict("records") if hasattr(rows, "to_dict") else list(rows)
        columns = columns or {key: key for row in rows for key in row}
        columns = {key: heading for key, heading in columns.items() if any(text_of(row.get(key)) for row in rows)}
        head = "".join(f"<th>{html.escape(heading)}</th>" for heading in columns.values())
        body = ""
        for row in rows:
            cells = ""
            for key in columns:
                value = row.get(key)
                number = isinstance(value, (int, float)) and not isinstance(value, bool)
                cells += f'<td{" class=number" if number else ""}>{html.escape(text_of(value))}</td>'
            body += f"<tr>{cells}</tr>"
        self.parts.append(f'<div class="scroll"><table><thead><tr>{head}</tr></thead>'
                          f'<tbody>{body}</tbody></table></div>')

    def keys(self, table):
        """A table of a scene as two columns."""
        self.table([{"key": key, "value": text_of(value)} for key, value in table.items()])

    def bullets(self, lines):
        self.parts.append("<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in lines) + "</ul>")

    def details(self, summary, text):
        self.parts.append(f"<details><summary>{html.escape(summary)}</summary><pre>{html.escape(text)}</pre></details>")

    def pictures(self, *pictures):
        """Pictures beside each other where there is room: pairs of PNG bytes and a caption."""
        figures = "".join(f'<figure><img alt="{html.escape(caption, quote=True)}" '
                          f'src="data:image/png;base64,{_base64(image)}">'
                          f"<figcaption>{html.escape(caption)}</figcaption></figure>" for image, caption in pictures)
        self.parts.append(f'<div class="pair">{figures}</div>' if len(pictures) > 1 else figures)

    def player(self, stills, caption):
        """Frames one after the other: pairs of time and PNG bytes."""
        frames = ",".join(f'{{"time":"{time:.4g}","image":"{_base64(image)}"}}' for time, image in stills)
        last = len(stills) - 1
        self.parts.append(
            f'<div class="player"><img alt="{html.escape(caption, quote=True)}">'
            '<div class="controls"><button type="button">Play</button>'
            f'<input type="range" min="0" max="{last}" value="{last}" aria-label="frame"><output></output></div>'
            f'<script type="application/json">[{frames}]</script></div><p class="note">{html.escape(caption)}</p>')

    def html(self):
        places = "".join(f'<a href="#{anchor}">{html.escape(name)}</a>' for anchor, name in self.places)
        return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><link rel="icon" href="data:,">'
                '<meta name="viewport" content="width=device-width, initial-scale=1">'
                f"<title>{html.escape(self.title)}</title><style>{STYLE}</style></head>\n<body>"
                f"<header><h1>{html.escape(self.title)}</h1>{''.join(self.head)}</header>\n<nav>{places}</nav>\n<main>"
                + "\n".join(self.parts)
                + "\n<footer>Written by gcpdda.report. Units are SI; the model is 1 m thick.</footer></main>\n"
                f"<script>{SCRIPT}</script></body></html>\n")


def _base64(image):
    return base64.b64encode(image).decode()
