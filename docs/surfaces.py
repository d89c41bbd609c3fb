"""Surfaces by their formula beside surf, POV-Ray and fidget: a table in Markdown of the CPU seconds for an image of 640 x 480 pixels.

    python3 docs/surfaces.py [-q] [ROUNDS] [NAME...]
    python3 docs/surfaces.py cost

The programs take turns, each on one thread, and the least time of some rounds counts. All of them show the part of the surface in
a ball, from the same place, by parallel rays through the same pixels, in one light. Pixels are wrong that show the surface where
another program shows none, or the other way round, and are not beside its silhouette in tabray's image, whose first hits
`tabray verify` proves. For POV-Ray's `isosurface`, a twentieth more than the steepest slope among thousands of points in the
ball is the `max_gradient`. fidget shows a solid of 480 voxels in depth: its pixels are compared with those of the same solid,
by `capped`. The last line compares 16 samples for each pixel with one. With `-q`, the isosurfaces and the 16 samples are left out, which take nearly all
of the time.

`cost` counts instructions with valgrind, for images of 32 x 24 pixels of formulas of growing degree, of more terms and of
more parts: docs/data/surfaces.csv, and its chart, docs/charts/surfaces.svg.

TABRAY names a program other than a new build. A program that is not installed is left out.
"""

import ast
import math
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT = 640, 480
# surf shows 20 units from the bottom of an image to its top, and turns a surface around y and then around x.
SHOWN, TURNS = 20.0, (0.5, 0.35)
# The radius of the ball in these units.
BALL = 9.0
# The CPU seconds after which a program is stopped.
LIMIT = 60


def chebyshev(degree: int, name: str) -> str:
    """The polynomial of Chebyshev in a variable, as sums of powers."""
    before, this = {0: 1}, {1: 1}
    for _ in range(degree - 1):
        after = {power + 1: 2 * factor for power, factor in this.items()}
        for power, factor in before.items():
            after[power] = after.get(power, 0) - factor
        before, this = this, after
    return " + ".join(f"({factor})*{name}^{power}" for power, factor in sorted(this.items()) if factor)


def chmutov(degree: int) -> str:
    return " + ".join(chebyshev(degree, name) for name in "xyz") + (" + 1" if degree % 2 else "")


def product_of_planes(count: int) -> str:
    """Planes like the sides of a prism, whose product is a little less than a sphere's function."""
    angles = (2 * math.pi * side / count for side in range(count))
    return "*".join(f"({math.cos(angle)!r}*x + {math.sin(angle)!r}*y - 0.9)" for angle in angles)


GOLDEN = "1.618033988749895"
BARTH6 = f"4*({GOLDEN}^2*x^2 - y^2)*({GOLDEN}^2*y^2 - z^2)*({GOLDEN}^2*z^2 - x^2) - (1 + 2*{GOLDEN})*(x^2 + y^2 + z^2 - 1)^2"
BARTH10 = (
    f"8*(x^2 - {GOLDEN}^4*y^2)*(y^2 - {GOLDEN}^4*z^2)*(z^2 - {GOLDEN}^4*x^2)"
    "*(x^4 + y^4 + z^4 - 2*x^2*y^2 - 2*x^2*z^2 - 2*y^2*z^2)"
    f" + (3 + 5*{GOLDEN})*(x^2 + y^2 + z^2 - 1)^2*(x^2 + y^2 + z^2 - 2 + {GOLDEN})^2"
)
GYROID = "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)"
LIDINOID = (
    "0.5*(sin(2*x)*cos(y)*sin(z) + sin(2*y)*cos(z)*sin(x) + sin(2*z)*cos(x)*sin(y))"
    " - 0.5*(cos(2*x)*cos(2*y) + cos(2*y)*cos(2*z) + cos(2*z)*cos(2*x)) + 0.15"
)

# The name, the radius of the ball and the formula; those with functions are no polynomials.
SURFACES = [
    ("ellipsoid", 2.2, "x^2/4 + y^2 + z^2/2 - 1"),
    ("hyperboloid", 3.0, "x^2 + y^2 - z^2 - 0.5"),
    ("Cayley's cubic", 2.0, "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1"),
    ("Clebsch's cubic", 2.2, "x^3 + y^3 + z^3 + 1 - (x + y + z + 1)^3"),
    ("ding-dong", 1.6, "x^2 + y^2 - (1 - z)*z^2"),
    ("torus", 1.6, "(x^2 + y^2 + z^2 + 0.75)^2 - 4*(x^2 + z^2)"),
    ("Steiner's Roman surface", 1.2, "x^2*y^2 + y^2*z^2 + z^2*x^2 - x*y*z"),
    ("cube of tubes", 2.5, "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8"),
    ("Kummer's quartic", 2.2, "(x^2 + y^2 + z^2 - 1.69)^2 - 3.1*((1 - z)^2 - 2*x^2)*((1 + z)^2 - 2*y^2)"),
    ("Togliatti's quintic", 4.0,
     "64*(x - 1)*(x^4 - 4*x^3 - 10*x^2*y^2 - 4*x^2 + 16*x - 20*x*y^2 + 5*y^4 + 16 - 20*y^2)"
     " - 8.312538755549068*(2*z - 1.6625077511098136)*(4*(x^2 + y^2 - z^2) + 7.708203932499369)^2"),
    ("heart", 1.5, "(2*x^2 + y^2 + z^2 - 1)^3 - 0.1*x^2*z^3 - y^2*z^3"),
    ("Barth's sextic", 2.0, BARTH6),
    ("Hunt's surface", 6.0, "4*(x^2 + y^2 + z^2 - 13)^3 + 27*(3*x^2 + y^2 - 4*z^2 - 12)^2"),
    ("six rings", 1.4,
     "((x^2 + y^2 - 0.64)^2 + (z^2 - 1)^2)*((y^2 + z^2 - 0.64)^2 + (x^2 - 1)^2)*((z^2 + x^2 - 0.64)^2 + (y^2 - 1)^2) - 0.02"),
    ("pretzel", 1.6, "(x^2*(1 - x^2) - y^2)^2 + z^2/2 - (1 + x^2 + y^2 + z^2)/40"),
    ("Chmutov 6", 1.2, chmutov(6)),
    ("Chmutov 8", 1.2, chmutov(8)),
    ("Barth's decic", 2.0, BARTH10),
    ("Chmutov 10", 1.2, chmutov(10)),
    ("Chmutov 12", 1.2, chmutov(12)),
    ("Chmutov 14", 1.2, chmutov(14)),
    ("Chmutov 16", 1.2, chmutov(16)),
    ("prism of 15 planes", 1.6, f"{product_of_planes(15)} - 0.02 + 0.5*z^16"),
    ("Chmutov 20", 1.2, chmutov(20)),
    ("gyroid", 6.0, GYROID),
    ("Schwarz's P", 6.0, "cos(x) + cos(y) + cos(z)"),
    ("lidinoid", 6.0, LIDINOID),
    ("three blobs", 2.0,
     "0.5 - exp(-4*((x - 0.5)^2 + y^2 + z^2)) - exp(-4*((x + 0.5)^2 + y^2 + z^2)) - exp(-4*(x^2 + (y - 0.7)^2 + z^2))"),
    ("waves", 3.0, "y - 0.2*sin(4*x)*cos(3*z) - 0.1*sin(x*z)"),
    ("rounded box", 1.4,
     "sqrt(max(abs(x) - 0.7, 0)^2 + max(abs(y) - 0.5, 0)^2 + max(abs(z) - 0.3, 0)^2) - 0.1"),
]


class Poly:
    """A polynomial in x, y and z: the factors of its powers."""

    def __init__(self, terms):
        self.terms = {powers: factor for powers, factor in terms.items() if factor}

    def __add__(self, other):
        terms = dict(self.terms)
        for powers, factor in of(other).terms.items():
            terms[powers] = terms.get(powers, 0) + factor
        return Poly(terms)

    def __mul__(self, other):
        terms = {}
        for one, factor in self.terms.items():
            for two, times in of(other).terms.items():
                powers = tuple(a + b for a, b in zip(one, two))
                terms[powers] = terms.get(powers, 0) + factor * times
        return Poly(terms)

    def __neg__(self):
        return self * -1

    def __sub__(self, other):
        return self + -of(other)

    def __rsub__(self, other):
        return of(other) - self

    def __truediv__(self, number):
        return self * (1 / number)

    def __pow__(self, exponent):
        result = of(1)
        for _ in range(exponent):
            result = result * self
        return result

    __radd__, __rmul__ = __add__, __mul__


def of(value):
    return value if isinstance(value, Poly) else Poly({(0, 0, 0): value})


FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "exp", "sqrt")} | {"max": max, "abs": abs}


def evaluated(formula, x, y, z):
    """The value of a formula of this page; they have no other names than these."""
    tree = compile(ast.parse(formula.replace("^", "**"), mode="eval"), "formula", "eval")
    return eval(tree, {"__builtins__": {}, "x": x, "y": y, "z": z, **FUNCTIONS})


def is_polynomial(formula):
    return not re.search("[a-z]{2}", formula)


def expanded(formula):
    return evaluated(formula, *(Poly({tuple(int(side == axis) for side in range(3)): 1.0}) for axis in range(3)))


def steepest(formula, radius):
    """The steepest slope in a ball, by differences at random points."""
    dice, most, step = random.Random(1), 0.0, radius * 1e-6
    tree = compile(ast.parse(formula.replace("^", "**"), mode="eval"), "formula", "eval")
    value = lambda at: eval(tree, {"__builtins__": {}, **dict(zip("xyz", at)), **FUNCTIONS})
    for _ in range(6000):
        at = [dice.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(side * side for side in at))
        # The slopes of polynomials are steepest near the ball's surface.
        at = [radius * dice.random() ** 0.1 * side / length for side in at]
        beside = ([side + step * (own == axis) for own, side in enumerate(at)] for axis in range(3))
        here = value(at)
        most = max(most, math.sqrt(sum(((value(other) - here) / step) ** 2 for other in beside)))
    return 1.05 * most


def directions():
    """The unit vectors to the right, upward and toward the viewer."""
    (sin_x, cos_x), (sin_y, cos_y) = ((math.sin(turn), math.cos(turn)) for turn in TURNS)
    return [cos_y, 0.0, -sin_y], [-sin_y * sin_x, cos_x, -cos_y * sin_x], [sin_y * cos_x, sin_x, cos_y * cos_x]


def row(numbers, by=" "):
    return by.join(repr(number) for number in numbers)


def ours(formula, radius, samples=1):
    _, up, back = directions()
    unit = radius / BALL
    at = [4 * radius * side for side in back]
    return f"""orthographic eye {{
    pixeldim {WIDTH} {HEIGHT}  position {row(at)}  target 0 0 0  up {row(up)}
    width {SHOWN * WIDTH / HEIGHT * unit!r}  samples {samples}
}}
material white {{ ambient 0.2 0.2 0.2  diffuse 0.8 0.8 0.8 }}
sphere ball {{ material white  center 0 0 0  radius {radius} }}
implicit surface {{ material white  formula "{formula}"  clip ball }}
sun key {{ direction {row(back)}  emissivity 1 1 1 }}
"""


def surf(formula, radius, out):
    # A unit of surf is this part of the ball.
    scaled = re.sub(r"\b([xyz])\b", rf"(\1*{radius / BALL!r})", formula)
    return f"""width = {WIDTH}; height = {HEIGHT}; perspective = parallel;
rot_x = {TURNS[0]}; rot_y = {TURNS[1]}; rot_z = 0.0;
clip = sphere; radius = {BALL};
surface = {scaled};
draw_surface;
color_file_format = ppm; filename = "{out}"; save_color_image;
"""


def pov(formula, radius, how):
    right, up, back = directions()
    unit = radius / BALL
    half = [SHOWN * unit * WIDTH / HEIGHT, SHOWN * unit]
    vector = lambda of: f"<{row(of, ',')}>"
    # Its coordinates are left-handed: all vectors are given in them, and the third of an image's is forward.
    if how == "poly":
        terms = expanded(formula).terms
        degree = max(sum(powers) for powers in terms)
        factors = [
            terms.get((x, y, z), 0.0)
            for x in range(degree, -1, -1) for y in range(degree - x, -1, -1) for z in range(degree - x - y, -1, -1)
        ]
        shape = f"poly {{ {degree}, {vector(factors)} sturm clipped_by {{ sphere {{ 0, {radius} }} }} }}"
    else:
        function = powers(formula)
        shape = f"""isosurface {{ function {{ {function} }} contained_by {{ sphere {{ 0, {radius} }} }}
    accuracy 1e-9 max_gradient {steepest(formula, radius)!r} open }}"""
    return f"""#version 3.7;
global_settings {{ assumed_gamma 1 }}
camera {{ orthographic location {vector([4 * radius * side for side in back])}
    direction {vector([-side for side in back])} up {vector([half[1] * side for side in up])}
    right {vector([half[0] * side for side in right])} }}
light_source {{ {vector([1e5 * side for side in back])} rgb 1 parallel point_at 0 shadowless }}
object {{ {shape} pigment {{ rgb 1 }} finish {{ ambient 0.2 diffuse 0.8 }} }}
"""


def fidget(formula, radius):
    """The solid in the ball, as fidget reads it: an operation on each line, with a name."""
    lines = []

    def put(*words):
        lines.append(f"_{len(lines)} {' '.join(words)}")
        return f"_{len(lines) - 1}"

    def value(node):
        match node:
            case ast.Constant(number):
                return put("const", repr(float(number)))
            case ast.Name(name):
                return put(f"var-{name}")
            case ast.UnaryOp(ast.USub(), of):
                return put("neg", value(of))
            case ast.BinOp(base, ast.Pow(), ast.Constant(power)):
                of = power_of = value(base)
                for bit in f"{power:b}"[1:]:
                    power_of = put("square", power_of)
                    if bit == "1":
                        power_of = put("mul", power_of, of)
                return power_of
            case ast.BinOp(one, sign, other):
                return put({"Add": "add", "Sub": "sub", "Mult": "mul", "Div": "div"}[type(sign).__name__], value(one), value(other))
            case ast.Call(ast.Name(name), of):
                return put(name, *map(value, of))
            case _:
                raise ValueError(ast.dump(node))

    inside = f"max({formula}, x^2 + y^2 + z^2 - {radius * radius!r})"
    value(ast.parse(inside.replace("^", "**"), mode="eval").body)
    return "\n".join(lines)


def fidget_view(radius):
    """The columns of the matrix from fidget's world, in which the image is 2 units high, to the formula's coordinates."""
    unit = SHOWN / 2 * radius / BALL
    return [repr(unit * side) for direction in directions() for side in direction]


def powers(formula):
    """Writes powers of sums as those of `pow`, from the innermost ones outward."""
    place = formula.find("^")
    while place >= 0:
        start = place - 1
        if formula[start] == ")":
            depth = 0
            while True:
                depth += {")": 1, "(": -1}.get(formula[start], 0)
                if depth == 0:
                    break
                start -= 1
        while start > 0 and re.match(r"[\w.]", formula[start - 1]):
            start -= 1
        exponent = re.match(r"\d+", formula[place + 1:]).group()
        end = place + 1 + len(exponent)
        formula = f"{formula[:start]}pow({formula[start:place]},{exponent}){formula[end:]}"
        place = formula.find("^")
    return formula


def seconds(command):
    """The CPU seconds of a command; `None` if it fails or takes too long."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    limited = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    done = subprocess.run(command, capture_output=True, preexec_fn=limited, cwd=tempfile.gettempdir())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        if done.returncode < 0:
            return None
        print(done.stderr.decode(errors="replace")[-600:], file=sys.stderr)
        return None
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def shown(picture):
    """Which pixels of a PPM image are not those of its corner."""
    data = picture.read_bytes()[-3 * WIDTH * HEIGHT:]
    return [data[3 * place:3 * place + 3] != data[:3] for place in range(WIDTH * HEIGHT)]


def wrong(known, other):
    """How many pixels differ, of those all of whose neighbours are alike in the first image."""
    count = 0
    for place in range(WIDTH + 1, WIDTH * (HEIGHT - 1) - 1):
        if known[place] != other[place]:
            beside = (known[place + across + WIDTH * down] for across in (-1, 0, 1) for down in (-1, 0, 1))
            count += all(pixel == known[place] for pixel in beside)
    return count


def terms(count: int) -> str:
    """A sphere with this number of small terms of degrees up to 8."""
    powers = [(x, y, z) for x in range(9) for y in range(9 - x) for z in range(9 - x - y)]
    dice = random.Random(2)
    chosen = dice.sample(powers, count)
    small = [f"{dice.uniform(-0.1, 0.1):.3f}*x^{x}*y^{y}*z^{z}" for x, y, z in chosen]
    return " + ".join(["x^2 + y^2 + z^2 - 0.8", *small])


def parts(count: int) -> str:
    """The union of this number of balls."""
    dice, size = random.Random(3), 0.7 / count ** (1 / 3)
    places = [[dice.uniform(-0.7, 0.7) for _ in range(3)] for _ in range(count)]
    ball = lambda x, y, z: f"sqrt((x - {x:.3f})^2 + (y - {y:.3f})^2 + (z - {z:.3f})^2) - {size:.4f}"
    balls = [ball(*place) for place in places]
    return f"min({', '.join(balls)})" if count > 1 else balls[0]


# What grows, its sizes, and the formula of a size.
GROWING = [
    ("degree: Chmutov's surfaces", range(4, 41, 4), chmutov),
    ("degree: a product of planes", range(4, 41, 4), lambda count: f"{product_of_planes(count)} - 0.02"),
    ("terms of degrees up to 8", [5, 10, 20, 40, 80, 160], terms),
    ("parts of a union", [1, 4, 16, 64, 256, 1000], parts),
]


def instructions(program, scene):
    """The instructions of a small image, in millions."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "render", scene, "--size", "32x24"]
    done = subprocess.run(
        [*command, "--threads", "1", "-o", scene.with_suffix(".ppm")], capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1)) / 1e6


def cost(program):
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(4) as threads:
        # Instructions are counted one by one, whatever else runs.
        def counted(text):
            scene = Path(folder) / f"{hash(text)}.ray"
            scene.write_text(text)
            return threads.submit(instructions, program, scene)

        start = counted(ours("x", 1.2).replace("clip ball", "box 2 2 2 3 3 3").replace('"x"', '"x - 2.5"'))
        rows = [(name, size, counted(ours(formula(size), 1.2))) for name, sizes, formula in GROWING for size in sizes]
        rows = [(name, size, count.result() - start.result()) for name, size, count in rows]
    lines = [f"{name},{size},{count:.1f}" for name, size, count in rows]
    (ROOT / "docs/data/surfaces.csv").write_text("\n".join(["what,size,million instructions", *lines, ""]))
    (ROOT / "docs/charts/surfaces.svg").write_text(chart(rows))


def chart(rows):
    """A panel for each thing that grows, with logarithmic scales. Two stand in a row, so that a phone shows them large."""
    wide, tall, most = 260, 240, 10 ** math.ceil(math.log10(max(count for *_, count in rows)))
    least = 10 ** math.floor(math.log10(min(count for *_, count in rows)))
    width, height = 2 * wide, 40 + 2 * (tall + 70)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
           f'<rect width="{width}" height="{height}" fill="#FFFFFF"/>',
           '<text x="10" y="20" font-weight="bold">million instructions for 32 x 24 pixels, beyond an empty image</text>']
    for panel, (name, sizes, _) in enumerate(GROWING):
        left, low, high = 55 + panel % 2 * wide, math.log(min(sizes)), math.log(max(sizes))
        top = 70 + panel // 2 * (tall + 70)
        right = lambda size: left + (wide - 75) * (math.log(size) - low) / (high - low)
        down = lambda count: top + tall * (1 - math.log(count / least) / math.log(most / least))
        out.append(f'<text x="{left}" y="{top - 14}">{name}</text>')
        for power in range(round(math.log10(least)), round(math.log10(most)) + 1):
            y = down(10 ** power)
            out.append(f'<path d="M{left} {y:.1f}H{left + wide - 75}" stroke="#DDDDDD"/>')
            out.append(f'<text x="{left - 4}" y="{y + 5:.1f}" text-anchor="end">{10 ** power:g}</text>')
        own = [(size, count) for of, size, count in rows if of == name]
        line = " ".join(f"{right(size):.1f},{down(count):.1f}" for size, count in own)
        out.append(f'<polyline fill="none" stroke="#1F77B4" stroke-width="2" points="{line}"/>')
        free = left - 20
        for size, count in own:
            out.append(f'<circle cx="{right(size):.1f}" cy="{down(count):.1f}" r="3" fill="#1F77B4"/>')
            # Numbers that would touch the one before are left out.
            half = 4.2 * len(str(size))
            if right(size) - half > free:
                out.append(f'<text x="{right(size):.1f}" y="{top + tall + 18}" text-anchor="middle">{size}</text>')
                free = right(size) + half + 2
    return "\n".join([*out, "</svg>", ""])


def main():
    is_quick = sys.argv[1:2] == ["-q"]
    rounds, *names = sys.argv[2 if is_quick else 1:] or ["3"]
    program = os.environ.get("TABRAY")
    if not program:
        subprocess.run(["cargo", "build", "--profile", "dist", "--locked", "--quiet"], cwd=ROOT, check=True)
        program = str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "dist/tabray")
    if names == [] and rounds == "cost":
        return cost(program)
    peers = {"surf": next(filter(shutil.which, ["surf-alggeo-nox", "surf-alggeo"]), None), "poly": "povray", "isosurface": "povray"}
    for name in [name for name, peer in peers.items() if not (peer and shutil.which(peer))]:
        print(f"SKIPPED: {peers.pop(name) or name} is not installed", file=sys.stderr)
    if is_quick:
        peers.pop("isosurface", None)
    built = subprocess.run(["cargo", "build", "--release", "--locked", "--quiet", "--target-dir", ROOT / "target/fidget"], cwd=ROOT / "docs/fidget")
    if built.returncode == 0:
        peers["fidget"] = ROOT / "target/fidget/release/fidget-peer"
    else:
        print("SKIPPED: docs/fidget does not compile", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        table(Path(folder), int(rounds), names, program, peers, is_quick)


def table(folder, rounds, names, program, peers, is_quick):
    print("| surface | degree | tabray (s) |" + "".join(f" {name} (s) | wrong |" for name in peers) + (" 16 samples (s) |" if not is_quick else ""))
    print("|---|--:|--:|" + "--:|--:|" * len(peers) + ("--:|" if not is_quick else ""), flush=True)
    sums = [0.0, 0.0]
    for name, radius, formula in SURFACES:
        if names and name not in names:
            continue
        out = {peer: folder / f"{peer}.ppm" for peer in ["tabray", *peers]}
        commands = {}
        (folder / "ours.ray").write_text(ours(formula, radius))
        commands["tabray"] = [program, "render", folder / "ours.ray", "--threads", "1", "-o", out["tabray"]]
        (folder / "many.ray").write_text(ours(formula, radius, 16))
        if not is_quick:
            commands["many"] = [program, "render", folder / "many.ray", "--threads", "1", "-o", folder / "many.ppm"]
        for peer in peers:
            if peer in ("surf", "poly") and not is_polynomial(formula):
                continue
            if peer == "fidget":
                (folder / "fidget.vm").write_text(fidget(formula, radius))
                commands[peer] = [peers[peer], folder / "fidget.vm", str(WIDTH), str(HEIGHT), out[peer], *fidget_view(radius)]
                continue
            text = surf(formula, radius, out[peer]) if peer == "surf" else pov(formula, radius, peer)
            scene = folder / f"scene.{peer}"
            scene.write_text(text)
            commands[peer] = [peers[peer], "-q", scene] if peer == "surf" else [
                "povray", f"+I{scene}", f"+W{WIDTH}", f"+H{HEIGHT}", "-A", "+WT1", "+FP", f"+O{out[peer]}", "-D", "-P", "-V", "-GA"]
        least = {}
        for turn in range(rounds):
            for peer, command in commands.items():
                if turn > 0 and (least[peer] is None or least[peer] > 20):
                    continue
                spent = seconds(command)
                least[peer] = spent if turn == 0 else min(least[peer], spent)
        (folder / "solid.ray").write_text(ours(formula, radius).replace("clip ball", "clip ball  capped yes"))
        solid = out["tabray"].with_name("solid.ppm")
        subprocess.run([program, "render", folder / "solid.ray", "--force", "--quiet", "-o", solid], check=True)
        degree = max(sum(powers) for powers in expanded(formula).terms) if is_polynomial(formula) else "–"
        line, known = f"| {name} | {degree} | {told(least['tabray'])} |", shown(out["tabray"])
        for peer in peers:
            is_shown = least.get(peer) is not None
            right = shown(solid) if peer == "fidget" else known
            line += f" {told(least[peer])} | {wrong(right, shown(out[peer]))} |" if is_shown else (
                " stopped | |" if peer in commands else " | |")
        if is_quick:
            print(line, flush=True)
            continue
        sums = [sums[0] + least["tabray"], sums[1] + least["many"]]
        print(f"{line} {told(least['many'])} |", flush=True)
    if is_quick:
        return
    print(f"\n16 samples take {sums[1] / sums[0]:.1f} times as long as one.")


def told(spent):
    return f"{spent:.2f}"


if __name__ == "__main__":
    main()
