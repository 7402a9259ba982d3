"""The tape: random programs against NumPy, folding, fusing, guards, refused control flow."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nullmotion as nm
from nullmotion import ops
from nullmotion.compile import CompiledFunction, Program, Symbol, compile_function, host, trace
from nullmotion.compile import tape as tp
from nullmotion.compile.operations import OPERATIONS
from nullmotion.compile.program import finish, interpret
from nullmotion.compile.schedule import scheduled
from nullmotion.compile.tape import Tape
from nullmotion.errors import TraceError

INPUTS = 4
STEPS = 30
POINTS = 21
CONSTANTS = [1.0, -1.0, 2.0, 0.5, -4.0, 3.7, -0.1, 1e-3, 1e200, 5e-324, 0.0, -0.0, np.inf]
SPECIAL = [0.0, -0.0, 1.0, -2.5, np.inf, -np.inf, np.nan, 5e-324, 1e308, -1e308, 0.5, 1.5]

Step = tuple[str, tuple[int, ...]]  # an operation and the values it takes


class Recipe:
    """A random program, as symbols on a tape and as a list of steps for NumPy.

    The tape folds x + 0, 0 * x, x - x and x / inf without looking at signs of zero, infinities
    and NaN (said at its rules); programs here do not ask for these, so that nothing is excused.
    """

    def __init__(self, seed: int) -> None:
        """Draw a program."""
        self.rng = np.random.default_rng(seed)
        self.tape = Tape()
        self.symbols: list[Symbol] = [self.tape.input(f"x{i}") for i in range(INPUTS)]
        self.steps: list[Step | float | bool] = []
        self.reals, self.booleans = list(range(INPUTS)), []
        for value in self.rng.choice(CONSTANTS, 3, replace=False):
            self.constant(float(value))
        self.compare()
        while len(self.steps) < STEPS:
            self.draw()
        self.outputs = [self.real() for _ in range(4)]
        self.outputs.append(self.put("select", self.boolean(), self.reals[INPUTS], self.real()))

    def constant(self, value: float | bool) -> int:
        """Add a constant."""
        return self._add(value, Symbol(self.tape, self.tape.constant(value)))

    def put(self, op: str, *args: int) -> int:
        """Add an operation on earlier values."""
        symbols = [self.symbols[a] for a in args]
        return self._add((op, args), tp.apply(op, *symbols))

    def _add(self, step: Step | float | bool, symbol: Symbol) -> int:
        self.steps.append(step)
        self.symbols.append(symbol)
        index = len(self.symbols) - 1
        (self.booleans if symbol.kind == "bool" else self.reals).append(index)
        return index

    def real(self) -> int:
        """Return a random real value, the latest more often."""
        back = min(int(self.rng.exponential(6.0)), len(self.reals) - 1)
        return self.reals[-1 - back]

    def boolean(self) -> int:
        """Return a random boolean."""
        return int(self.rng.choice(self.booleans))

    def compare(self) -> int:
        """Add a comparison."""
        name = self.rng.choice(["less", "less_equal", "equal"])
        return self.put(str(name), self.real(), self.real())

    def tame(self, x: int, low: float, high: float) -> int:
        """Return a value in [low, high] that is not NaN (whose sign is not ours to fix)."""
        bounds = [self.constant(v) for v in (low, high)]
        above = self.put("select", self.put("less", bounds[0], x), x, bounds[0])
        return self.put("select", self.put("less", above, bounds[1]), above, bounds[1])

    def draw(self) -> None:
        """Add a random operation."""
        name = str(self.rng.choice(list(DRAWS)))
        DRAWS[name](self, name)

    def excused(self, op: str, *args: int) -> bool:
        """Return whether a folding rule would change a special value here."""
        ids = [self.symbols[a].node for a in args]
        nodes = [self.tape.nodes[i] for i in ids]
        constants = [n.value for n in nodes if n.op == "constant"]
        if op in ("add", "sub", "mul") and 0.0 in constants:
            return True
        if op == "div" and nodes[1].op == "constant" and np.isinf(nodes[1].value):
            return True
        opposite = ("neg", ids[0]) == (nodes[1].op, *nodes[1].args)
        opposite |= ("neg", ids[1]) == (nodes[0].op, *nodes[0].args)
        return (op == "sub" and ids[0] == ids[1]) or (op == "add" and opposite)

    def program(self, fuse: bool) -> Program:
        """Return the finished program."""
        inputs = self.symbols[:INPUTS]
        return finish(self.tape, inputs, [self.symbols[o] for o in self.outputs], fuse)

    def directly(self, inputs: list[np.ndarray]) -> list[np.ndarray]:
        """Evaluate step by step with NumPy, never touching the tape."""
        values: list[Any] = list(inputs)
        with np.errstate(all="ignore"):
            for step in self.steps:
                if isinstance(step, tuple):
                    values.append(OPERATIONS[step[0]].evaluate(*[values[a] for a in step[1]]))
                else:
                    values.append(step)
        return [np.broadcast_to(values[o], inputs[0].shape) for o in self.outputs]


def _binary(recipe: Recipe, op: str) -> None:
    args = recipe.real(), recipe.real()
    if not recipe.excused(op, *args):
        recipe.put(op, *args)


def _bit(recipe: Recipe, op: str) -> None:
    whole = recipe.put("rint", recipe.tame(recipe.real(), -(2.0**31) + 1, 2.0**31 - 1))
    recipe.put(op, whole, recipe.constant(float(recipe.rng.integers(0, 32))))


def _raw_bit(recipe: Recipe, op: str) -> None:
    place = recipe.constant(float(recipe.rng.integers(0, 64)))
    recipe.put(op, recipe.tame(recipe.real(), -1e300, 1e300), place)


def _flip(recipe: Recipe, op: str) -> None:
    place = recipe.constant(float(recipe.rng.integers(0, 64)))
    recipe.put(op, recipe.real(), recipe.tame(recipe.real(), -1e300, 1e300), place)


DRAWS: dict[str, Callable[[Recipe, str], Any]] = {
    **dict.fromkeys(("add", "sub", "mul", "product", "div"), _binary),
    **dict.fromkeys(("neg", "fabs", "rint"), lambda r, op: r.put(op, r.real())),
    **dict.fromkeys(("less", "less_equal", "equal"), lambda r, op: r.put(op, r.real(), r.real())),
    **dict.fromkeys(("and", "or"), lambda r, op: r.put(op, r.boolean(), r.boolean())),
    "not": lambda r, op: r.put(op, r.boolean()),
    "fma": lambda r, op: r.put(op, r.real(), r.real(), r.real()),
    "select": lambda r, op: r.put(op, r.boolean(), r.real(), r.real()),
    "sqrt": lambda r, op: r.put(op, r.put("fabs", r.real())),
    "copysign": lambda r, op: r.put(op, r.real(), r.tame(r.real(), -1e300, 1e300)),
    "exponent": lambda r, op: r.put(op, r.tame(r.real(), -1e300, 1e300)),
    "significand": lambda r, op: r.put(op, r.tame(r.real(), -1e300, 1e300)),
    "power_of_two": lambda r, op: r.put(op, r.put("rint", r.tame(r.real(), -1022.0, 1023.0))),
    "bit": _bit,
    "raw_bit": _raw_bit,
    "flip": _flip,
    "rsqrt_guess": lambda r, op: r.put(op, r.tame(r.real(), 1e-300, 1e300)),
    "constant": lambda r, op: r.constant(float(r.rng.choice(CONSTANTS))),
    "flag": lambda r, op: r.constant(bool(r.rng.integers(0, 2))),
}


def points(rng: np.random.Generator) -> list[np.ndarray]:
    """Return inputs of every size, special values among them."""
    out = []
    for _ in range(INPUTS):
        x = rng.normal(size=POINTS) * 10.0 ** rng.integers(-3, 4, POINTS)
        x[: POINTS // 3] = rng.choice(SPECIAL, POINTS // 3)
        out.append(x)
    return out


def compiled(program: Program, width: int | None = None) -> CompiledFunction:
    """Compile a program of scalars."""
    return CompiledFunction(program, (0.0,) * len(program.outputs), width or host().lanes)


def same_bits(a: Any, b: Any) -> bool:
    """Return whether two arrays hold the same bits, any NaN for any NaN."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return bool(np.all((a.view(np.int64) == b.view(np.int64)) | (np.isnan(a) & np.isnan(b))))


def test_every_operation_is_drawn() -> None:
    assert set(OPERATIONS) <= set(DRAWS)
    used = {s[0] for seed in range(40) for s in Recipe(seed).steps if isinstance(s, tuple)}
    assert used == set(OPERATIONS)


@pytest.mark.parametrize(
    "block", [*range(4), *(pytest.param(b, marks=pytest.mark.slow) for b in range(4, 20))]
)
def test_random_programs_agree_with_numpy_bit_for_bit(block: int) -> None:
    for seed in range(25 * block, 25 * block + 25):
        recipe = Recipe(seed)
        inputs, program = points(recipe.rng), recipe.program(fuse=False)
        truth = recipe.directly(inputs)
        interpreted = interpret(program, inputs)
        for i, found in enumerate(compiled(program)(*inputs)):
            assert same_bits(found, truth[i]), f"compiled, seed {seed}, output {i}"
            wide = np.broadcast_to(interpreted[i], truth[i].shape)
            assert same_bits(wide, truth[i]), f"interpreted, seed {seed}, output {i}"


@pytest.mark.parametrize(
    "seed",
    [*range(0, 100, 25), *(pytest.param(s, marks=pytest.mark.slow) for s in range(100, 500, 25))],
)
def test_every_width_gives_the_same_bits(seed: int) -> None:
    recipe = Recipe(seed)
    inputs, program = points(recipe.rng), recipe.program(fuse=True)
    results = [compiled(program, width)(*inputs) for width in (1, 2, 4, 8)]
    for other in results[1:]:
        assert all(same_bits(a, b) for a, b in zip(results[0], other, strict=True))


@pytest.mark.parametrize("seed", range(0, 500, 10))
def test_fused_programs_run_as_interpreted(seed: int) -> None:
    recipe = Recipe(seed)
    inputs, program = points(recipe.rng), recipe.program(fuse=True)
    for found, truth in zip(compiled(program)(*inputs), interpret(program, inputs), strict=True):
        assert same_bits(found, np.broadcast_to(truth, found.shape))


def polynomial(rng: np.random.Generator) -> Recipe:
    """Return a random program of sums and products."""
    recipe = Recipe.__new__(Recipe)
    recipe.rng, recipe.tape, recipe.steps = rng, Tape(), []
    recipe.symbols = [recipe.tape.input(f"x{i}") for i in range(INPUTS)]
    recipe.reals, recipe.booleans = list(range(INPUTS)), []
    for value in rng.normal(size=3):
        recipe.constant(float(value))
    while len(recipe.steps) < 20:
        op = str(rng.choice(["add", "sub", "mul", "neg", "fabs"]))
        value = recipe.put(op, *[recipe.real() for _ in OPERATIONS[op].operands])
        if op == "mul":
            recipe.put(str(rng.choice(["add", "sub"])), value, recipe.real())
            recipe.reals.remove(value)  # so that nothing else needs the product
    recipe.outputs = recipe.reals[-4:]
    return recipe


def exact_with_bound(recipe: Recipe, inputs: list[float]) -> list[tuple[Fraction, Fraction]]:
    """Return each output's exact value and a bound of the error of rounding every operation.

    Fusing leaves roundings out, so the same bound holds for it.
    """
    unit = Fraction(1, 2**53)
    values = [(Fraction(x), Fraction(0)) for x in inputs]
    for step in recipe.steps:
        if not isinstance(step, tuple):
            values.append((Fraction(step), Fraction(0)))
            continue
        (x, ex), (y, ey) = ([values[a] for a in step[1]] * 2)[:2]
        if step[0] in ("neg", "fabs"):
            values.append((abs(x) if step[0] == "fabs" else -x, ex))
            continue
        if step[0] == "mul":
            value, carried = x * y, abs(x) * ey + abs(y) * ex + ex * ey
        else:
            value, carried = (x + y if step[0] == "add" else x - y), ex + ey
        values.append((value, carried + unit * (abs(value) + carried) + Fraction(1, 2**1000)))
    return [values[o] for o in recipe.outputs]


@pytest.mark.parametrize("block", range(5))
def test_fused_programs_stay_within_rounding_bounds(block: int) -> None:
    fused_somewhere = 0
    for seed in range(10 * block, 10 * block + 10):
        rng = np.random.default_rng(1000 + seed)
        recipe, inputs = polynomial(rng), rng.normal(size=(INPUTS, 6))
        program = recipe.program(fuse=True)
        fused_somewhere += program.count()["fma"]
        found = np.stack(compiled(program)(*inputs), axis=-1)
        for column, row in zip(inputs.T, found, strict=True):
            for (value, bound), result in zip(
                exact_with_bound(recipe, column.tolist()), row, strict=True
            ):
                assert abs(Fraction(float(result)) - value) <= bound, f"seed {seed}"
    assert fused_somewhere > 10


def traced(function: Callable[..., Any], count: int, fuse: bool = False) -> Program:
    """Trace a function of scalars."""
    return trace(function, *[1.0] * count, fuse=fuse)[0]


def test_constants_fold() -> None:
    def source(x: Any) -> Any:
        table = np.array([1.0, 2.0, 4.0])
        return x * (table @ table - 20.0) + 0.0 * x + ops.where(table[0] < 2.0, 0.0, x)

    program = traced(source, 1)
    assert program.operations == 0 and program.outputs == program.inputs


@pytest.mark.parametrize(
    ("source", "operations"),
    [
        (lambda x, y: x + 0.0, 0),
        (lambda x, y: 0.0 * x + y, 0),
        (lambda x, y: tp.apply("neg", tp.apply("neg", x)), 0),
        (lambda x, y: x - x, 0),
        (lambda x, y: x + -y, 1),
        (lambda x, y: x - tp.apply("neg", y), 1),
        (lambda x, y: -1.0 * x, 1),
        (lambda x, y: x**1, 0),
        (lambda x, y: x**8, 3),
        (lambda x, y: tp.select(x < y, x, x), 0),
        (lambda x, y: tp.select(tp.apply("or", x < y, True), x, y), 0),
        (lambda x, y: tp.select(tp.apply("and", x < y, x < y), x, y), 2),
    ],
)
def test_identities_fold(source: Callable[..., Any], operations: int) -> None:
    assert traced(source, 2).operations == operations


def test_division_by_a_power_of_two_becomes_an_exact_product() -> None:
    program = traced(lambda x: (x / 8.0, x / 3.0), 1)
    assert program.count()["mul"] == 1 and program.count()["div"] == 1


def test_constants_share_a_node_only_if_their_bits_are_equal() -> None:
    tape = Tape()
    assert tape.constant(0.0) != tape.constant(-0.0)
    assert tape.constant(True) != tape.constant(1.0)
    assert tape.constant(np.float64(0.1)) == tape.constant(0.1)
    assert tape.constant(np.nan) == tape.constant(np.nan)


def test_common_subexpressions_are_recorded_once() -> None:
    def source(x: Any, y: Any) -> Any:
        first = ops.sqrt(x * y + 1.0)
        again = ops.sqrt(1.0 + y * x)  # operands swapped: still the same
        return first + again, first * again

    assert traced(source, 2).count() == {"input": 2, "constant": 1, "mul": 2, "add": 2, "sqrt": 1}


def test_dead_code_is_dropped() -> None:
    def source(x: Any, y: Any) -> Any:
        for _ in range(100):
            y = ops.sqrt(y * y + x)
        return x + 1.0

    program = traced(source, 2)
    assert program.operations == 1 and len(program.inputs) == 2
    assert same_bits(compiled(program)(np.ones(3), np.ones(3))[0], np.full(3, 2.0))


def test_operands_come_first() -> None:
    for seed in range(50):
        for fuse in (False, True):
            for i, node in enumerate(Recipe(seed).program(fuse).nodes):
                assert all(a < i for a in node.args)


@pytest.mark.parametrize("registers", [1, 8, 26])
def test_scheduling_changes_the_order_alone(registers: int) -> None:
    moved = 0
    for seed in range(30):
        recipe = Recipe(seed)
        inputs, before = points(recipe.rng), recipe.program(fuse=True)
        after = scheduled(before, registers)
        assert all(a < i for i, node in enumerate(after.nodes) for a in node.args)
        assert after.count() == before.count() and len(after.nodes) == len(before.nodes)
        moved += [n.op for n in after.nodes] != [n.op for n in before.nodes]
        found, truth = interpret(after, inputs), interpret(before, inputs)
        assert all(same_bits(a, b) for a, b in zip(found, truth, strict=True))
    assert moved > 20


def test_scheduling_starts_long_chains_early() -> None:
    def source(x: Any, y: Any) -> Any:
        return x + y, x - y, ops.sqrt(ops.sqrt(x))

    order = [n.op for n in scheduled(traced(source, 2)).nodes if n.op != "input"]
    assert order[0] == "sqrt"


def test_scheduling_keeps_guards() -> None:
    def source(x: Any) -> Any:
        tp.guard("positive", x > 0.0)
        return x * x, 3.0

    program = scheduled(traced(source, 1))
    assert program.nodes[program.guards["positive"]].op == "less"
    assert program.nodes[program.outputs[1]].value == 3.0


def test_multiply_adds_fuse() -> None:
    def dot(a: Any, b: Any, c: Any, d: Any, e: Any, f: Any) -> Any:
        return np.array([a, b, c]) @ np.array([d, e, f])

    assert {**traced(dot, 6, fuse=True).count()} == {"input": 6, "fma": 2, "mul": 1}
    assert traced(lambda a, b, c: a * b - c, 3, fuse=True).count()["fma"] == 1
    assert traced(lambda a, b, c: c - a * b, 3, fuse=True).count()["fma"] == 1


def test_fma_is_rounded_once_and_its_product_cannot_overflow() -> None:
    fma = OPERATIONS["fma"].evaluate
    assert fma(1e308, -1e308, np.inf) == np.inf
    assert fma(0.1, 10.0, -1.0) == 2.0**-54
    assert fma(1e200, 1e200, -1.0) == np.inf and fma(np.inf, 1.0, 1.0) == np.inf


def test_a_product_with_other_uses_is_not_fused() -> None:
    assert traced(lambda a, b, c: (a * b, a * b + c), 3, fuse=True).count()["fma"] == 0
    assert traced(lambda a, b, c: (a * b) ** 2 + (a * b + c), 3, fuse=True).count()["mul"] == 1
    assert traced(lambda a, b, c: tp.product(a, b) + c, 3, fuse=True).count()["fma"] == 0


def test_a_product_that_only_sums_use_is_fused_into_all_of_them() -> None:
    program = traced(lambda a, b, c, d: (a * b + c, d - a * b), 4, fuse=True)
    assert program.count()["fma"] == 2 and program.count()["mul"] == 0


def line_of(marker: str) -> int:
    """Return the line of this file that ends in a marker."""
    lines = Path(__file__).read_text().splitlines()
    return 1 + next(i for i, text in enumerate(lines) if text.endswith(f"# {marker}"))


def branching(x: Any) -> Any:
    """Decide by a value."""
    if x > 0.0:  # the branch
        return x
    return -x


def comparing(x: Any) -> Any:
    """Decide by a value inside Python's max."""
    return max(x, 2.0 * x)  # the maximum


def equating(x: Any) -> Any:
    """Decide by equality, which Python would answer by identity."""
    return 1.0 if x == 0.0 else 1.0 / x  # the equality


def converting(x: Any) -> Any:
    """Ask for the number behind a symbol."""
    return float(x)  # the number


def doubting(x: Any) -> Any:
    """Take a number for a condition."""
    return ops.where(x, 1.0, 2.0)  # the condition


@pytest.mark.parametrize(
    ("source", "marker", "advice"),
    [
        (doubting, "the condition", "compare it"),
        (branching, "the branch", "nullmotion.ops.where"),
        (comparing, "the maximum", "maximum"),
        (equating, "the equality", "where"),
        (converting, "the number", "still a symbol"),
    ],
)
def test_control_flow_by_value_is_refused(source: Any, marker: str, advice: str) -> None:
    with pytest.raises(TraceError, match=advice) as caught:
        trace(source, 1.0)
    assert caught.value.file == __file__ and caught.value.line == line_of(marker)
    assert f"{__file__}:{line_of(marker)}: " in str(caught.value)
    assert isinstance(caught.value, nm.NullmotionError)


def test_powers_that_are_not_whole_are_refused() -> None:
    with pytest.raises(TraceError, match="power"):
        trace(lambda x: x**1.5, 1.0)


def test_equality_is_recorded() -> None:
    def source(x: Any, y: Any) -> Any:
        return ops.where(x == y, 1.0, 2.0), ops.where(x != 3.0, 1.0, 2.0)

    x, y = np.array([1.0, 3.0, np.nan, -0.0]), np.array([1.0, 2.0, np.nan, 0.0])
    same, different = compile_function(source, 1.0, 1.0)(x, y)
    assert np.array_equal(same, [1, 2, 2, 1]) and np.array_equal(different, [1, 2, 1, 1])


def test_symbols_equal_other_things_as_objects_do() -> None:
    x = Tape().input("x")
    assert (x == "x") is False and (x != "x") is True
    assert isinstance(x == x, Symbol) and isinstance(x == 2.0, Symbol)
    assert {x: 1}[x] == 1  # by identity


@pytest.mark.parametrize("known", [True, False, np.True_, np.False_])
def test_booleans_are_chosen_by_what_is_known(known: bool) -> None:
    def source(x: Any, y: Any) -> Any:
        chosen = ops.where(known, x < 0.0, y < 0.0)
        either = ops.where(x < 0.0, y < 0.0, known)
        return ops.where(chosen, 1.0, 0.0), ops.where(either, 1.0, 0.0)

    x, y = np.array([-1.0, -1.0, 1.0, 1.0]), np.array([-1.0, 1.0, -1.0, 1.0])
    chosen, either = compile_function(source, 1.0, 1.0)(x, y)
    assert np.array_equal(chosen, np.where(known, x, y) < 0)
    assert np.array_equal(either, np.where(x < 0, y < 0, known))


def test_truths_count_as_one_and_zero() -> None:
    def source(x: Any, y: Any) -> Any:
        positive = x > 0.0
        return (
            y * positive,
            positive + y,
            1.0 - (x > y) * True,
            ops.where(positive, y > 0.0, 0.5) + 0.0,
            ops.where(ops.where(positive, True, False), x, y),
        )

    x, y = np.array([-1.0, 2.0, 3.0]), np.array([2.0, -3.0, 4.0])
    truth = [y * (x > 0), (x > 0) + y, 1.0 - (x > y), [0.5, 0, 1], np.where(x > 0, x, y)]
    for found, expected in zip(compile_function(source, 1.0, 1.0)(x, y), truth, strict=True):
        np.testing.assert_array_equal(found, expected)


def test_guards_are_reported_run_by_run() -> None:
    def source(x: Any, y: Any) -> Any:
        tp.guard("positive", x > 0.0)
        tp.guard("small", abs(y) < 10.0)
        tp.guard("positive", x + y > 0.0)  # a flag may have several conditions
        tp.guard("always", True)
        return x + y

    function = compile_function(source, 1.0, 1.0)
    assert list(function.program.guards) == ["positive", "small"]
    x, y = np.array([1.0, -1.0, 1.0, 3.0, np.nan]), np.array([1.0, 5.0, -2.0, 11.0, 1.0])
    assert same_bits(function(x, y), x + y)
    raised = [[False, True, True, False, True], [False, False, False, True, False]]
    assert np.array_equal(function.status, raised)


def test_guards_of_dead_code_still_hold() -> None:
    def source(x: Any) -> Any:
        tp.guard("flag", x * x < 4.0)
        return x

    function = compile_function(source, 1.0)
    function(np.array([1.0, 3.0]))
    assert np.array_equal(function.status, [[False, True]])


@pytest.mark.parametrize("count", [1, 2, 3, 7, 8, 9, 1000])
def test_batches_of_any_size(count: int) -> None:
    x = np.random.default_rng(0).normal(size=(count, 3))
    found = compile_function(lambda v: (v @ v, v[::-1] * 2.0), np.zeros(3), fuse=False)(x)
    assert found[0].shape == (count,) and found[1].shape == (count, 3)
    assert same_bits(found[1], 2.0 * x[:, ::-1])
    assert same_bits(found[0], x[:, 0] * x[:, 0] + x[:, 1] * x[:, 1] + x[:, 2] * x[:, 2])


def test_shared_operations_on_floats_arrays_and_symbols() -> None:
    def source(a: Any, b: Any) -> Any:
        return (
            ops.minimum(a, b),
            ops.maximum(a, b),
            ops.clip(a, -1.0, b),
            ops.sign(a),
            ops.where(ops.logical_and(ops.less(a, b), ops.logical_not(ops.equal(a, 0.0))), a, b),
            ops.where(ops.logical_or(ops.greater(a, b), ops.greater_equal(b, 1.0)), a, -b),
            ops.amax(np.array([a, b, 0.5 * a])),
            ops.amin(np.array([a, b, 0.5 * a])),
            ops.power(ops.absolute(a), 3.0),
            ops.power(ops.absolute(b), 0.5),
            ops.copysign(a, ops.where(ops.equal(b, b), b, 1.0)),  # a NaN's sign is not ours
        )

    rng = np.random.default_rng(1)
    a, b = rng.choice([*SPECIAL, *rng.normal(size=20)], (2, 200))
    with np.errstate(all="ignore"):
        one_by_one = np.array([source(x, y) for x, y in zip(a, b, strict=True)], float).T
    for found, truth in zip(compile_function(source, 1.0, 1.0)(a, b), one_by_one, strict=True):
        zero = found == truth  # powers and products with zero may lose its sign
        assert np.all(zero | (np.isnan(found) & np.isnan(truth)) | np.isclose(found, truth, 1e-15))


def test_minimum_and_maximum_return_the_second_beside_a_nan() -> None:
    x, y = np.array([np.nan, 1.0]), np.array([1.0, np.nan])
    for extreme in (ops.minimum, ops.maximum):
        for found in (extreme(x, y), compile_function(extreme, 1.0, 1.0)(x, y)):
            assert found[0] == 1.0 and np.isnan(found[1])
    assert np.isnan(ops.clip(np.nan, -1.0, 1.0))
