"""A checked scenario."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from nullmotion import laws
from nullmotion.errors import UnsupportedArrayError
from nullmotion.scenario.schema import (
    About,
    ArraySection,
    CaseSection,
    InitialSection,
    LawSection,
    MissionSection,
    PlantSection,
    RequirementsSection,
    SimulationSection,
    StopSection,
)
from nullmotion.scenario.schema_spacecraft import (
    ControllerSection,
    DesaturationSection,
    DisturbanceSection,
    EventSection,
    PlanSection,
    ReactionWheelSection,
    SensorsSection,
    ServoSection,
    SpacecraftSection,
)
from nullmotion.scenario.schema_vscmg import VscmgSection
from nullmotion.scenario.source import Source
from nullmotion.scenario.validate import Validator


@dataclass(frozen=True)
class Scenario:
    """The sections of a scenario file, each checked by itself and with the others.

    Attributes:
        source: Text and files that it comes from.
        about: Title and description.
        plant: None when the real array is as the law is told.
        stop: Thresholds at which the run ends.
        cases: What `compare` runs beside the law.
        spacecraft: The body that carries the array; None unless the mission turns it.
        controller: What makes the command from the attitude, likewise.
        servo: None when gimbals follow at once.
        sensors: None when rate and attitude are measured exactly.
        disturbance: None when no torque comes from outside.
        desaturation: None when nothing takes momentum off the array.
        reaction_wheel: None when the array alone gives torque.
        events: Faults.
        plan: How null motion is planned; None unless the file has such a section.
        requirements: Limits of the summary's numbers, likewise.
        vscmg: The units of variable-speed CMGs on a spacecraft, likewise.
    """

    source: Source
    about: About
    array: ArraySection
    plant: PlantSection | None
    initial: InitialSection
    law: LawSection
    mission: MissionSection
    simulation: SimulationSection
    stop: StopSection
    cases: tuple[CaseSection, ...]
    spacecraft: SpacecraftSection | None = None
    controller: ControllerSection | None = None
    servo: ServoSection | None = None
    sensors: SensorsSection | None = None
    disturbance: DisturbanceSection | None = None
    desaturation: DesaturationSection | None = None
    reaction_wheel: ReactionWheelSection | None = None
    events: tuple[EventSection, ...] = ()
    plan: PlanSection | None = None
    requirements: RequirementsSection | None = None
    vscmg: VscmgSection | None = None

    @property
    def name(self) -> str:
        """Short name: that of the file without its ending."""
        return PurePath(self.source.name).stem or "scenario"

    @property
    def variable_speed(self) -> bool:
        """Whether wheel speeds change: by the law, or as units of their own say."""
        return self.vscmg is not None or laws.get(self.law.name).turns_wheels

    @property
    def title(self) -> str:
        """Title, or the name where the file gives none."""
        return self.about.title or self.name

    def with_values(self, values: Mapping[str, Any], origin: str = "value") -> Scenario:
        """Return the scenario with values set by dotted key, checked again."""
        return checked(self.source.over(values, origin)) if values else self

    def with_law(self, case: CaseSection) -> Scenario:
        """Return the scenario with the law of a case; period and delay stay.

        Raises:
            UnsupportedArrayError: When that law cannot fly what this one can.
        """
        from nullmotion.scenario.startup_checks import unsuitable  # it works on a Scenario

        reason = unsuitable(self, laws.get(case.name))
        if reason:
            raise UnsupportedArrayError(case.name, reason)
        own = {k: getattr(case, k) for k in case.model_fields_set if k != "label"}
        kept = {k: getattr(self.law, k) for k in ("period_s", "delay_s") if self.law.given(k)}
        return checked(self.source.over({"law": {**own, **kept}}, "compare.case"))

    def named_files(self) -> dict[str, str]:
        """Return the text of the files that the scenario names."""
        name = self.mission.profile
        return {} if name is None else {name: self.source.read(name)}

    def layout_parameters(self) -> dict[str, Any]:
        """Return the layout's parameters as in files, defaults put in."""
        from nullmotion.scenario import objects, sections

        if self.array.layout == sections.CUSTOM:
            return {}
        return sections.written(objects.layout(self.array))


_OPTIONAL = (
    "spacecraft",
    "controller",
    "servo",
    "sensors",
    "disturbance",
    "desaturation",
    "reaction_wheel",
    "plan",
    "requirements",
    "vscmg",
)


def checked(source: Source) -> Scenario:
    """Return the scenario of a source.

    Raises:
        ScenarioError: With everything that is wrong.
    """
    from nullmotion.scenario.checks import check  # it builds arrays and laws from a Scenario

    validator = Validator(source)
    found = validator.sections()
    validator.raise_problems()
    scenario = Scenario(
        source,
        found.get("scenario") or About(),
        found["array"],
        found.get("plant"),
        found.get("initial") or InitialSection(),
        found["law"],
        found["mission"],
        found["simulation"],
        found["stop"],
        tuple(found["compare"]),
        events=tuple(found["event"]),
        **{name: found.get(name) for name in _OPTIONAL},
    )
    check(scenario, validator)
    validator.raise_problems()
    return scenario
