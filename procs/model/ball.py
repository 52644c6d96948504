"""The ball of the middle size league: a football of size 5 on short carpet."""

from pydantic import BaseModel, ConfigDict, Field


class BallModel(BaseModel):
    """Size, mass and friction; simulator, vision, world model and behaviour use the same."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    radius_m: float = Field(default=0.11, ge=0.01, le=0.3)
    """Radius in metres. Rule book of 2016: a circumference of 0.68 to 0.70 m."""
    mass_kg: float = Field(default=0.43, ge=0.001, le=1.0)
    """Mass in kilograms. Rule book of 2016: 0.41 to 0.45 kg."""
    sliding_m_s2: float = Field(default=3.0, gt=0.0, le=100.0)
    """Deceleration in m/s² while the ball slides, as after a kick. TIGERs: 3.0, ER-Force: 2.8 to 3.9."""
    rolling_m_s2: float = Field(default=0.4, gt=0.0, le=100.0)
    """Deceleration in m/s² of the rolling ball. Small size league: 0.26 to 0.5; none is published for this league."""
    bounce: float = Field(default=0.6, ge=0.0, le=1.0)
    """Share of the vertical speed that a bounce on carpet leaves. FIFA: at least 0.82 on steel; carpet absorbs more."""
    least_rebound_m_s: float = Field(default=0.5, ge=0.0, le=100.0)
    """Vertical speed below which the ball stays on the ground instead of bouncing. An estimate."""
    spin_s: float = Field(default=0.5, gt=0.0, le=1000.0)
    """Time constant in s with which the ground stops a spin around the vertical. An estimate."""
    standstill_m_s: float = Field(default=0.01, ge=0.0, le=1.0)
    """Speed in m/s below which a rolling ball rests. An estimate: it would roll 0.1 mm further."""
    inertia: float = Field(default=2 / 3, ge=0.1, le=1.0)
    """Moment of inertia divided by mass and squared radius: 2/3 for a thin shell, 2/5 for a solid ball."""

    @property
    def rolling_share(self) -> float:
        """Share of a kick's speed that is left when the ball begins to roll."""
        return 1 / (1 + self.inertia)


BALL = BallModel()
"""The usual ball."""
RADIUS_M = BALL.radius_m
