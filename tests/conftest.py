"""Settings that every test runs with."""

import signal

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

# A shell starts what runs in the background deaf to Ctrl-C, which some tests send.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser):
    parser.addoption(
        "--refresh-golden", action="store_true", help="write the topologies kept as text anew"
    )
