"""Settings that every test runs with."""

from hypothesis import HealthCheck, settings

# The same examples in every run: a test that fails here fails for everyone.
settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    database=None,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("fuzz", derandomize=False, deadline=None, max_examples=2000)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    parser.addoption(
        "--refresh-golden", action="store_true", help="write the topologies kept as text anew"
    )
