"""The table, and the bars that the project has set itself."""

import math

POV = "povray"


def rate(result, name):
    run = result["runs"].get(name)
    return run["rate"] if run else None


def words(value, unit=1e-6):
    if value is None:
        return "-"
    value *= unit
    return f"{value:.3f}" if value < 10 else f"{value:.1f}"


def line(results, programs):
    """Prints the last result, and the heading before the first."""
    names = [program.name for program in programs]
    ours = names[0]
    if len(results) == 1:
        print("million rays per CPU-second of tracing; (side of the picture where it is not the first program's)")
        head = ["scene"] + names + [f"/{name}" for name in names[1:]]
        head += ["hits", "shadow rays", "differing", "cells", "kB", "build s", "tests", "CPU s, whole"]
        print("  ".join(f"{word:>12}" for word in head))
    result = results[-1]
    own = result["runs"].get(ours)
    cells = [result["scene"]]
    for name in names:
        run = result["runs"].get(name)
        side = f" ({run['side']})" if run and own and run["side"] != own["side"] else ""
        cells.append(words(rate(result, name)) + side)
    for name in names[1:]:
        other, first = rate(result, name), rate(result, ours)
        cells.append(f"{first / other:.2f}" if first and other else "-")
    counts = result["runs"].get(POV)
    if counts:
        cells.append(f"{counts['reference_hits']}={counts['hits']}")
        cells.append(f"{counts['reference_shadow_rays']}={counts['shadow_rays']}")
    else:
        cells += [str(own["hits"]), str(own["shadow_rays"])]
    cells.append(f"{100 * max(run['differing'] for run in result['runs'].values()):.3f} %")
    cells += [str(own["cells"]), str(own["bytes"] // 1000), f"{own['build_seconds']:.3f}", f"{own['tests_per_ray']:.2f}"]
    cells.append("/".join(f"{run['whole_seconds']:.2f}" for run in result["runs"].values()))
    print("  ".join(f"{cell:>12}" for cell in cells), flush=True)


def mean(ratios):
    return math.exp(sum(map(math.log, ratios)) / len(ratios))


def bars(results, names):
    """Checks what can be checked with these scenes and programs, prints it and gives it as data."""
    ours, others = names[0], [name for name in names[1:] if name != POV]
    found = []

    def bar(what, value, least):
        found.append({"bar": what, "value": round(value, 3), "least": least, "met": value >= least})

    def ratios(name, wanted=lambda result: True):
        both = [r for r in results if wanted(r) and rate(r, ours) and rate(r, name)]
        return {r["scene"]: rate(r, ours) / rate(r, name) for r in both}

    def least(what, of, bound):
        if of:
            scene = min(of, key=of.get)
            bar(f"{what} (least: {scene})", of[scene], bound)

    one_solid = lambda low, high: lambda r: not r["is_union"] and low <= r["operands"] < high
    least(f"{ours} / {POV}, every scene", ratios(POV), 2.0)
    least(f"{ours} / {POV}, 100 operands of one solid and more", ratios(POV, one_solid(100, 900)), 20.0)
    least(f"{ours} / {POV}, 1000 operands of one solid and more", ratios(POV, one_solid(900, 1e9)), 150.0)
    for name in others:
        strategy = name.split()[-1]
        if strategy == "tree" and ratios(name):
            bar(f"{ours} / {name}, geometric mean of all scenes", mean(ratios(name).values()), 3.0)
        if strategy in ("kd", "native"):
            some = ratios(name, lambda r: 200 <= r["operands"] <= 2200)
            if some:
                bar(f"{ours} / {name}, geometric mean at 200 to 2000 operands", mean(some.values()), 6.0)
        least(f"{ours} / {name}, every scene", ratios(name), 0.95)
    if others:
        best = [
            rate(r, ours) / max(rate(r, name) for name in others if rate(r, name))
            for r in results
            if rate(r, ours) and any(rate(r, name) for name in others)
        ]
        if best:
            bar(f"{ours} / best of the other strategies, geometric mean of all scenes", mean(best), 1.5)
    of = {r["scene"]: rate(r, ours) for r in results}
    if of.get("cheese-10000") and of.get("cheese-100"):
        bar("cheese-10000 / cheese-100", of["cheese-10000"] / of["cheese-100"], 0.6)
    if of.get("union-100000") and of.get("union-1000"):
        bar("union-100000 / union-1000", of["union-100000"] / of["union-1000"], 0.4)
    own = [(r, r["runs"][ours]) for r in results if r["runs"].get(ours, {}).get("primitives", 0) >= 50]
    if own:
        slowest = max(own, key=lambda x: x[1]["build_seconds"] / x[1]["primitives"])
        milliseconds = 1e3 * slowest[1]["build_seconds"] / slowest[1]["primitives"]
        bar(f"primitives built in 0.1 ms (fewest: {slowest[0]['scene']})", 0.1 / milliseconds, 1.0)
        largest = max(own, key=lambda x: x[1]["bytes"] / x[1]["primitives"])
        bar(f"primitives in 2 kB (fewest: {largest[0]['scene']})", 2000 * largest[1]["primitives"] / largest[1]["bytes"], 1.0)
    for entry in found:
        print(f"{'met   ' if entry['met'] else 'MISSED'}  {entry['value']:>9.2f} >= {entry['least']:<6}  {entry['bar']}")
    return found
