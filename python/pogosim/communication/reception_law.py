"""The laws by which messages get through, as src/comms/reception.cpp has them.

Both give the probability that one receiver gets a message, from the size m of the message in bytes (header and
payload), the chance p that a robot sends in a tick, and the cluster size c: the robots in reach of the transmission and
the sender.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    import numpy.typing as npt

    from pogosim.communication.equations import Floats

SHORT_HEADER_BYTES = 3
LONG_HEADER_BYTES = 8


@dataclass(frozen=True)
class ReceptionLaw:
    """What both laws have in common; their fields are the parameters, in the order of the formula."""

    NAME: ClassVar[str]

    def probability(
        self, message_bytes: npt.ArrayLike, send_probability: npt.ArrayLike, cluster_size: npt.ArrayLike
    ) -> Floats:
        """Return the probability of reception, in [0, 1]; the shapes are broadcast.

        Args:
            message_bytes: Header (3 in a short message, 8 in a long one) and payload, bytes, at least 0.
            send_probability: Chance to send in a tick, 0 to 1.
            cluster_size: The sender and the robots that its message reaches, at least 1.
        """
        return self.equation(message_bytes, send_probability, cluster_size, **dataclasses.asdict(self))

    @classmethod
    def equation(
        cls,
        message_bytes: npt.ArrayLike,
        send_probability: npt.ArrayLike,
        cluster_size: npt.ArrayLike,
        **parameters: npt.ArrayLike,
    ) -> Floats:
        """Return the probability for many sets of parameters at once; all shapes are broadcast."""
        from pogosim.communication.equations import probability  # numpy takes a while

        return probability(cls.NAME, message_bytes, send_probability, cluster_size, **parameters)


@dataclass(frozen=True)
class DynamicLaw(ReceptionLaw):
    """The article's equation, with the parameters that it has fitted to measurements on real robots.

        P = 1 / (alpha + beta p^gamma c^delta exp(zeta m) + theta p c)

    Source: L. Cazenille, L. Macabre, N. Bredeche, "Pogosim - a Simulator for Pogobot robots", eq. 1.

    Attributes:
        alpha: Base of the denominator; 1/alpha is the probability for a message that meets no other.
        beta: Scale of collisions.
        gamma: Exponent of the chance to send.
        delta: Exponent of the cluster size.
        zeta: Growth of collisions with the size of the message, 1/byte.
        theta: Scale of the interaction of chance to send and cluster size.
    """

    NAME: ClassVar[str] = "dynamic"

    alpha: float = 1.03215183
    beta: float = 0.00073859
    gamma: float = 3.14782227
    delta: float = 3.52543753
    zeta: float = 0.05720136
    theta: float = 0.001


@dataclass(frozen=True)
class PowerLaw(ReceptionLaw):
    """The older four-parameter law, with the parameters of `msg_success_rate: {type: realistic}`.

        P = 1 / (1 + alpha m^beta p^gamma c^delta)

    Attributes:
        alpha: Scale of collisions.
        beta: Exponent of the size of the message.
        gamma: Exponent of the chance to send.
        delta: Exponent of the cluster size.
    """

    NAME: ClassVar[str] = "power"

    alpha: float = 4e-6
    beta: float = 2.8096
    gamma: float = 2.3807
    delta: float = 1.2457


Law = DynamicLaw | PowerLaw
LAWS: dict[str, type[DynamicLaw] | type[PowerLaw]] = {law.NAME: law for law in (DynamicLaw, PowerLaw)}


def parameter_names(law: type[DynamicLaw] | type[PowerLaw]) -> tuple[str, ...]:
    """Return the names of the parameters of a law, in the order of the formula."""
    return tuple(field.name for field in dataclasses.fields(law))


def parameters_of(law: Law) -> dict[str, float]:
    """Return the parameters of a law by name."""
    return dataclasses.asdict(law)


def configuration_block(law: Law) -> str:
    """Return the entry of a category in a configuration file that makes the simulator follow a law.

    The simulator recognises the four-parameter law by the absence of zeta and theta.
    """
    # A number like 1e-05 is a string to some YAML readers; 1.0e-05 is not.
    lines = [f"    {name}: {with_point(value)}" for name, value in parameters_of(law).items()]
    return "\n".join(["msg_success_rate:", "    type: dynamic", *lines])


def with_point(value: float) -> str:
    """Return a number with 9 digits and a point, as every YAML reader understands it: 1.0e-05."""
    mantissa, exponent, power = f"{value:.9g}".partition("e")
    return (mantissa if "." in mantissa else f"{mantissa}.0") + exponent + power
