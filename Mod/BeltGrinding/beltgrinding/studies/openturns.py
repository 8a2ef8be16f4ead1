"""OpenTURNS, where it is installed."""

from ..engine import InputError


def module():
    """The package. Raises InputError without it."""
    try:
        import openturns
    except ImportError as error:
        raise InputError(
            "studies.no_openturns",
            "Sobol indices need OpenTURNS ({reason}); install Debian's python3-openturns",
            reason=error,
        ) from None
    return openturns


def joint(marginals):
    """The distribution of independent variables."""
    ot = module()
    kind = ot.JointDistribution if hasattr(ot, "JointDistribution") else ot.ComposedDistribution
    return kind(list(marginals))
