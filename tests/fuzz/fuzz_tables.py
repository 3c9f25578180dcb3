"""What the fuzz prints when it has ended."""

import re
from collections import Counter, defaultdict

import numpy as np

VERDICTS = {
    "ok": "a mesh, and everything about it is right",
    "refused": "an error that names place and value",
    "signal": "the process died",
    "hang": "no answer at all",
    "late": "well beyond max_seconds",
    "invalid": "an invalid mesh",
    "metric": "a metric returned that is not positive definite",
    "changed": "a tag, measure, corner or frozen facet is lost, or the report is wrong",
    "budget": "refused where a mesh with converged=False is due",
    "unclear": "an error that names no place or no value",
    "unfounded": "a metric refused that doubles can hold",
    "exception": "an error of another type",
    "differs": "other bytes with other threads",
    "input": "the case itself could not be made",
    "lost": "a damaged file was read, and something is missing without a word",
    "memory": "more memory than a small file is worth",
}
"""Of a harsh case or a damaged file; all but the first two are failures."""

GROUPS = {"kind": "domain", "metric": "metric", "file": "file", "mutation": "mutation"}
"""What rows are counted by, and how a table calls it."""

FAILURES = [verdict for verdict in VERDICTS if verdict not in ("ok", "refused")]


def table_lines(rows):
    """Outcomes by kind of domain and of metric."""
    heads = ("", "cases", "bad", "refused", "certified", "stars ok", "s max")
    yield "{:18}{:>7}{:>6}{:>9}{:>11}{:>10}{:>7}".format(*heads)
    for kind, members in _groups(rows):
        made = [row for row in members if row.get("reason")]
        certified = np.mean([row["reason"] == "certified" for row in made]) if made else 0.0
        stars = np.mean([row["star_ok"] for row in made]) if made else 0.0
        bad, refused = (sum(bool(r.get(key)) for r in members) for key in ("problem", "error"))
        slowest = max(row["seconds"] for row in members)
        yield (
            f"{kind:18}{len(members):7}{bad:6}{refused:9}{certified:11.1%}{stars:10.2%}"
            f"{slowest:7.2f}"
        )
    for name, key in {"reason": "reason", "refusal": "error", "not generated": "skipped"}.items():
        yield from _most_common(name, (row.get(key, "") for row in rows))


def verdict_table_lines(rows):
    """Verdicts by kind of domain, metric, file and damage, and by what doubles can hold."""
    seen = {row["verdict"] for row in rows}
    columns = [verdict for verdict in VERDICTS if verdict in seen]
    yield f"{'':22}{'cases':>7}" + "".join(f"{verdict:>10}" for verdict in columns)
    for kind, members in _groups(rows):
        count = Counter(row["verdict"] for row in members)
        yield f"{kind:22}{len(members):7}" + "".join(f"{count[name]:10}" for name in columns)
    for verdict in columns:
        yield f"{verdict}: {VERDICTS[verdict]}"
    for name in ("refused", *FAILURES):
        yield from _most_common(name, (r["message"] for r in rows if r["verdict"] == name))
    yield from _most_common("warning", (row.get("warned", "") for row in rows))
    yield from _most_common("stop", (row.get("stop", "") for row in rows))
    if any("seconds" in row for row in rows):
        slowest = max(rows, key=lambda row: row.get("seconds", 0))
        yield f"slowest: case {slowest['number']}, {slowest['seconds']:.1f} s"


def _groups(rows):
    """Pairs of a name and its rows: domains, metrics, files, what the door lets in, and all."""
    groups = defaultdict(list)
    rows = [row for row in rows if row.keys() & GROUPS.keys()]
    for row in rows:
        for key, label in GROUPS.items():
            if key in row:
                groups[f"{label} {row[key]}"].append(row)
        if "beyond" in row:
            groups["ratio " + ("above" if row["beyond"] else "below") + " 1e14"].append(row)
    return [*sorted(groups.items()), *([("all", rows)] if rows else [])]


def _most_common(name, texts):
    """Lines that count texts which differ in their numbers only."""
    alike = (re.sub(r"[-+\d.][-+\d.e]*", "#", text) for text in texts)
    for text, count in Counter(filter(None, alike)).most_common(12):
        yield f"{name}: {count} x {text[:300]}"
