"""A file that describes an array: ``[array]``, its angles in ``[initial]``, or a whole scenario."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.scenario import array_checks, keys, objects, start, start_checks
from nullmotion.scenario.problems import MISSING
from nullmotion.scenario.scenario import Scenario, checked
from nullmotion.scenario.schema import About, ArraySection, InitialSection
from nullmotion.scenario.sections import SECTIONS
from nullmotion.scenario.source import Source
from nullmotion.scenario.validate import Validator

_ALONE = ("array", "initial", "scenario")
FLOWN = ("law", "mission", "simulation")  # any of them: it is meant as a whole scenario


def _refused(name: str) -> str:
    if name not in SECTIONS:
        return keys.hint(name, SECTIONS).replace("key", "section", 1)
    return "without [law], [mission] and [simulation] a file has [array], [initial], [scenario]"


@dataclass(frozen=True)
class ArrayFile:
    """An array and where it comes from.

    Attributes:
        source: Text and values set over it.
        section: The checked ``[array]``.
        array: The array that works, without the failed CMGs.
        title: Title that the file gives, or its name.
        initial: Where it starts from.
        scenario: The whole scenario; None when the file has an array alone.
    """

    source: Source
    section: ArraySection
    array: CmgArray
    title: str
    initial: InitialSection
    scenario: Scenario | None = None

    @property
    def name(self) -> str:
        """Short name: that of the file without its ending."""
        return PurePath(self.source.name).stem or "array"

    @property
    def start(self) -> np.ndarray:
        """Gimbal angles in the file, or those of the layout without momentum [rad], (n,)."""
        return start.angles(self.section, self.initial, self.array)


def array_file(source: Source) -> ArrayFile:
    """Return the array of a source.

    Raises:
        ScenarioError: With everything that is wrong.
    """
    if any(name in source.data for name in FLOWN):
        scenario = checked(source)
        made = objects.array(scenario.array)
        return ArrayFile(source, scenario.array, made, scenario.title, scenario.initial, scenario)
    validator = Validator(source)
    for name in source.data:
        if name not in _ALONE:
            validator.add((name,), MISSING, _refused(name))
    if "array" not in source.data:
        validator.add(("array",), MISSING, "this section is missing")
        validator.raise_problems()
    section = validator.section("array")
    about = validator.section("scenario") if "scenario" in source.data else About()
    initial = validator.section("initial") if "initial" in source.data else InitialSection()
    validator.raise_problems()
    array = array_checks.check(section, validator)
    if array is not None:
        start_checks.check(section, initial, array, validator)
    validator.raise_problems()
    assert array is not None
    title = about.title or PurePath(source.name).stem
    return ArrayFile(source, section, array, title, initial)
