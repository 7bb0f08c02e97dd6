"""The gyrostat as symbols: what an optimal control problem lets vary or holds."""

from dataclasses import dataclass, fields

import casadi as ca

from ocs_design.arrays import FloatArray
from ocs_design.sizing.gyrostat import Gyrostat


@dataclass(frozen=True, eq=False)
class Plant:
    """A gyrostat of CasADi symbols or numbers, see `Gyrostat`.

    Attributes:
        inertia: xx, yy, zz, xy, xz, yz [kg m^2], (6, 1).
        sine, cosine: of the incidence of the wheels' axes.
        spin_inertia, armature: [kg m^2].
    """

    inertia: ca.SX
    sine: ca.SX
    cosine: ca.SX
    spin_inertia: ca.SX
    armature: ca.SX

    @classmethod
    def of(cls, gyrostat: Gyrostat) -> "Plant":
        """The numbers of a gyrostat whose axes lie as `module_axes` puts them."""
        sine, cosine = gyrostat.axes[:2, 0]
        figures = (sine, cosine, gyrostat.spin_inertia, gyrostat.armature)
        return cls(ca.SX(moments(gyrostat.inertia)), *(ca.SX(float(figure)) for figure in figures))

    @classmethod
    def symbols(cls) -> "Plant":
        """One that is all symbols."""
        return cls(ca.SX.sym("inertia", 6), *(ca.SX.sym(name) for name in _SCALARS))

    def packed(self) -> ca.SX:
        """All in one column."""
        column: ca.SX = ca.vertcat(*(getattr(self, field.name) for field in fields(self)))
        return column

    @property
    def inertia_matrix(self) -> ca.SX:
        """I_tot, (3, 3)."""
        xx, yy, zz, xy, xz, yz = ca.vertsplit(self.inertia)
        rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        return ca.vertcat(*(ca.horzcat(*row) for row in rows))

    @property
    def axes(self) -> ca.SX:
        """A, (3, 2)."""
        s, c = self.sine, self.cosine
        return ca.vertcat(ca.horzcat(s, -s), ca.horzcat(c, c), ca.SX.zeros(1, 2))

    def momentum(self, rate: ca.SX, wheel_speed: ca.SX) -> ca.SX:
        """H = I_tot w + h A W."""
        return self.inertia_matrix @ rate + self.spin_inertia * (self.axes @ wheel_speed)

    def wheel_momentum(self, rate: ca.SX, wheel_speed: ca.SX) -> ca.SX:
        """What the motors change, h A^T w + (h + a) W."""
        driven = self.spin_inertia + self.armature
        return self.spin_inertia * (self.axes.T @ rate) + driven * wheel_speed


def moments(inertia: FloatArray) -> FloatArray:
    """xx, yy, zz, xy, xz, yz of a symmetric matrix, shape (6,)."""
    return inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


_SCALARS = ("sine", "cosine", "spin_inertia", "armature")
