"""Quantities with units: what is read, and what is said where there is none."""

from __future__ import annotations

import pytest

from eulerplateau.units import DIAMETER, LENGTH, RIGIDITY, SURFACE_TENSION, YOUNG, Measure


@pytest.mark.parametrize(
    ("measure", "alike"),
    [
        (LENGTH, ("20 cm", "20cm", " 200 mm", "0.2 m", "2e5 µm", "2e-4 km")),
        (YOUNG, ("2 GPa", "2e9 Pa", "2000 MPa", "2000 N/mm^2", "2000 N/mm²")),
        (
            SURFACE_TENSION,
            ("25 mN/m", "0.025 N/m", "25 dyn/cm", "25 mJ/m^2", "25 mN * m^-1"),
        ),
        (RIGIDITY, ("1.5e-7 N m^2", "1.5e-7 Pa m**4", "0.15 mN·mm·m", "0.15 N mm²")),
    ],
)
def test_one_quantity_in_many_units(measure: Measure, alike: tuple[str, ...]) -> None:
    values = [measure.read(text).value for text in alike]
    assert values == pytest.approx([values[0]] * len(values), rel=1e-14)
    for text in alike:
        read = measure.read(text)
        assert read.value / measure.factor(read.unit) == pytest.approx(
            float(text.replace("cm", "").split()[0]), rel=1e-14
        )


@pytest.mark.parametrize(
    "text",
    [
        "", "0.2", "mm", "0.2 kg", "0.2 apples", "-0.2 mm", "0 mm", "nan mm", "inf mm",
        "1e400 m", "1e-400 m", "0,2 mm", "1.2.3 mm", "0.2 mm^2", "20 degC", "1 m**9**9**9",
        "1 m^99999999", "(((", "2 m/0 s", "2 __import__('os')", "0.2 mm, 2 GPa", "5 dB",
    ],
)  # fmt: skip
def test_what_is_no_quantity_of_its_kind_is_told_in_a_line_with_an_example(
    text: str,
) -> None:
    with pytest.raises(ValueError, match=r"'0\.2 mm'") as caught:
        DIAMETER.read(text)
    assert "\n" not in str(caught.value)
