"""The scenes of the benchmark. Random ones draw from Python's Mersenne Twister with a fixed seed, so that they are the
same everywhere."""

import math
import random

from model import (
    Leaf, Node, Scene, add, apply, ball, block, camera_frame, compose, difference, leaves, rotation, scaling, sub, times,
    translation, union, unit,
)

NEAR = (2.4, -3.2, 2.1)


def scene(name, solids, eye, target=(0.0, 0.0, 0.0), **more):
    """The light is up on the right of the eye, as far away as it."""
    made = Scene(name, solids, eye, target, light=(0.0, 0.0, 0.0), **more)
    right, up, _ = camera_frame(made)
    way = sub(target, eye)
    distance = math.sqrt(sum(x * x for x in way))
    made.light = add(eye, times(add(right, times(up, 2.0)), distance))
    made.operands = made.operands or max(len(leaves(solid)) for solid in solids)
    return made


def point(rng):
    return tuple(rng.uniform(-1.0, 1.0) for _ in range(3))


def grooved(count):
    """Unit spheres with six grooves, each one torus of tube radius 0.06 about a great circle; on a ground."""
    side = math.ceil(math.sqrt(count))
    solids = [block((-12.0, -12.0, -1.3), (12.0, 12.0, -1.1))]
    for i in range(count):
        at = times((i % side - 0.5 * (side - 1), i // side - 0.5 * (side - 1), 0.0), 2.3)
        tori = [
            Leaf(
                "torus",
                {"major": 1.0, "minor": 0.06},
                compose(translation(at), compose(rotation(0, k * math.tau / 12), rotation(1, 0.3))),
            )
            for k in range(6)
        ]
        solids.append(difference(ball(at, 1.0), tori))
    return scene(f"grooved-{count}", solids, times(NEAR, 1.6 if side < 3 else 2.6))


def cheese(holes):
    """A cube with spherical holes at random."""
    rng = random.Random(11)
    radius = 0.9 / holes ** (1 / 3)
    balls = [ball(point(rng), radius * rng.uniform(0.5, 1.0)) for _ in range(holes)]
    return scene(f"cheese-{holes}", [difference(block((-1.0,) * 3, (1.0,) * 3), balls)], NEAR)


def holes(n):
    """A plate drilled by n times n cylinders."""
    step = 2.0 / n
    drills = [
        Leaf(
            "cylinder",
            {"radius": 0.35 * step, "height": 0.4},
            translation(((i % n + 0.5) * step - 1.0, (i // n + 0.5) * step - 1.0, -0.2)),
        )
        for i in range(n * n)
    ]
    return scene(f"holes-{n}", [difference(block((-1.0, -1.0, -0.1), (1.0, 1.0, 0.1)), drills)], times(NEAR, 0.7))


def nest(count):
    """Nested differences: a ball less ten smaller ones on its surface, each of which is a ball less ten smaller ones,
    and so on until all `count` balls are there; so matter and void take turns inwards."""
    golden = math.pi * (3.0 - math.sqrt(5.0))

    def child(center, radius, k):
        z = 1.0 - (2 * k + 1) / 10
        ring = math.sqrt(1.0 - z * z)
        direction = (ring * math.cos(golden * k), ring * math.sin(golden * k), z)
        return add(center, times(direction, 0.9 * radius)), 0.42 * radius

    balls = [((0.0, 0.0, 0.0), 1.2)]
    for i in range(1, count):
        balls.append(child(*balls[(i - 1) // 10], (i - 1) % 10))
    nodes = [None] * count
    for i in reversed(range(count)):
        below = [nodes[j] for j in range(10 * i + 1, min(10 * i + 11, count))]
        nodes[i] = difference(ball(*balls[i]), below) if below else ball(*balls[i])
    return scene(f"nest-{count}", [nodes[0]], NEAR)


def bead(i, radius):
    """Sphere `i` of a spiral that shrinks: the snail shell of the thesis."""
    shrink = 0.989228**i
    map = compose(rotation(2, math.radians(5.0) * i), scaling(shrink, shrink, shrink))
    return ball(apply(map, (-1.0, 0.0, -2.0)), shrink * radius)


MOUTH = {"eye": (4.5, -8.0, 1.0), "target": (0.0, 0.0, -1.6), "fov_degrees": 30.0}


def shell():
    """2 048 beads less 96 that hollow the outer whorl: 2 144 spheres."""
    beads, hollow = [bead(i, 1.0) for i in range(2048)], [bead(i - 14, 0.97) for i in range(96)]
    return scene("shell", [difference(union(beads), [union(hollow)])], **MOUTH)


def chain():
    """1 072 beads, and after each a dimple taken away: ((b0 - d0) | b1) - d1 … as it reads, left-deep."""
    node = None
    for i in range(1072):
        outer = bead(i, 1.0)
        center, radius = outer.size["center"], outer.size["radius"]
        way = unit((center[0], center[1], 0.4 * radius))
        dimple = ball(add(center, times(way, 0.95 * radius)), 0.3 * radius)
        node = outer if node is None else Node("union", [node, outer])
        node = Node("difference", [node, dimple])
    return scene("chain-2144", [node], **MOUTH)


def balls(count):
    """A union of small spheres at random."""
    rng = random.Random(12)
    radius = 0.7 / count ** (1 / 3)
    all = [ball(point(rng), radius * rng.uniform(0.5, 1.0)) for _ in range(count)]
    return scene(f"union-{count}", [union(all)], NEAR, is_union=True)


def random_leaf(rng, kinds, near):
    """One leaf that holds or nearly holds the point `near`."""
    a, b, c = (rng.uniform(0.12, 0.4) for _ in range(3))
    kind = kinds[rng.randrange(len(kinds))]
    size = {
        "sphere": {"radius": a, "center": (0.0, 0.0, 0.0)},
        "box": {"min": (-a, -b, -c), "max": (b, c, a)},
        "cylinder": {"radius": 0.6 * a, "height": 2.0 * b},
        "cone": {"base": a, "top": 0.3 * c, "height": 1.5 * b},
        "torus": {"major": a, "minor": 0.4 * b},
    }[kind]
    turn = compose(rotation(2, rng.uniform(0, math.tau)), rotation(0, rng.uniform(0, math.tau)))
    stretch = scaling(*(rng.uniform(0.7, 1.3) for _ in range(3)))
    at = add(near, times(point(rng), 0.2))
    return Leaf(kind, size, compose(translation(at), compose(turn, stretch)))


def mixed(count, kinds=("sphere", "box", "cylinder", "cone", "torus")):
    """A random tree over all kinds: one union of lumps less another. A lump is ten leaves or less around a point, joined
    by all three operators, so that few operands are without effect."""
    rng = random.Random(13)

    def tree(size, near):
        near = near or (times(point(rng), 0.9) if size <= 10 else None)
        if size == 1:
            return random_leaf(rng, kinds, near)
        left = rng.randrange(1, size) if near else size // 2
        operator = rng.choices(["union", "difference", "intersection"], [5, 4, 1])[0] if near else "union"
        return Node(operator, [tree(left, near), tree(size - left, near)])

    taken = count // 4
    return scene(f"mixed-{count}", [difference(tree(count - taken, None), [tree(taken, None)])], NEAR)


ALL = {
    made: make
    for made, make in [
        ("grooved-3", lambda: grooved(3)),
        ("grooved-12", lambda: grooved(12)),
        ("holes-10", lambda: holes(10)),
        ("holes-32", lambda: holes(32)),
        ("holes-100", lambda: holes(100)),
        ("cheese-100", lambda: cheese(100)),
        ("cheese-1000", lambda: cheese(1000)),
        ("cheese-10000", lambda: cheese(10000)),
        ("nest-100", lambda: nest(100)),
        ("nest-1000", lambda: nest(1000)),
        ("shell", shell),
        ("chain-2144", chain),
        ("union-1000", lambda: balls(1000)),
        ("union-10000", lambda: balls(10000)),
        ("union-100000", lambda: balls(100000)),
        ("mixed-200", lambda: mixed(200)),
    ]
}

QUICK = {
    "grooved-3": lambda: grooved(3),
    "holes-4": lambda: holes(4),
    "nest-30": lambda: nest(30),
    "mixed-25": lambda: mixed(25),
    "union-50": lambda: balls(50),
}
