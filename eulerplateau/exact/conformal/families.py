"""What the symmetry of a loop, or of its displacements, leaves of its harmonics."""

from __future__ import annotations

from dataclasses import dataclass

Harmonics = tuple[tuple[str, int], ...]  # ("cos" or "sin", parity of k)
_BOTH: Harmonics = (("cos", 0), ("cos", 1), ("sin", 0), ("sin", 1))


@dataclass(frozen=True)
class Family:
    """A symmetry of loops: the harmonics in each of the coordinates x, y and z."""

    name: str
    harmonics: tuple[Harmonics, Harmonics, Harmonics]

    def within(self, other: Family) -> bool:
        """Return whether all its loops, or displacements, are of another family too."""
        pairs = zip(self.harmonics, other.harmonics, strict=True)
        return all(set(mine) <= set(theirs) for mine, theirs in pairs)


def _family(name: str, x: str, y: str, z: str) -> Family:
    parts = tuple(((c.split()[0], int(c.split()[1])),) if c else () for c in (x, y, z))
    return Family(name, (parts[0], parts[1], parts[2]))


# Two mirror lines in the plane z = 0 (D2h), and the three half-turns about the axes (D2):
# about x, phi -> -phi; about z, phi -> phi + pi; about y, phi -> pi - phi.
PLANAR = _family("planar", "cos 1", "sin 1", "")
TWISTED = _family("all half-turns", "cos 1", "sin 1", "sin 0")
# The half-turn about x alone, of loops.
LOBED = Family(
    "half-turn about x",
    ((("cos", 0), ("cos", 1)), (("sin", 0), ("sin", 1)), (("sin", 0), ("sin", 1))),
)
# Displacements that keep one of the half-turns and break the others.
ABOUT_X = _family("half-turn about x", "cos 0", "sin 0", "sin 1")
ABOUT_Y = _family("half-turn about y", "sin 0", "cos 0", "cos 1")
ABOUT_Z = _family("half-turn about z", "sin 1", "cos 1", "cos 0")
GENERAL = Family("no symmetry", (_BOTH, _BOTH, _BOTH))
# Every displacement of a film of TWISTED or PLANAR is a sum of these, and its second
# variation mixes none of them.
HALF_TURNS = (TWISTED, ABOUT_X, ABOUT_Y, ABOUT_Z)
