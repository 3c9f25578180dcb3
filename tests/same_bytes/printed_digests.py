"""Print the digests of all results as JSON, with what the libraries below say about the CPU."""

import json
import sys

from cpu_levels import described
from result_digests import curved_results, digest, digests

from anistar.judging.quality import mean_ratios


def qualities(dim):
    """Digests of the mean ratios, which are computed outside the core."""
    return {
        f"{dim}D quality {name}": digest(mean_ratios(done.mesh, done.metric))
        for name, done in curved_results(dim).items()
    }


if __name__ == "__main__":
    found = digests(2) | qualities(2) | digests(3) | qualities(3)
    json.dump({"level": described(), "digests": found}, sys.stdout)
