"""Adapt a VTU file in ParaView, without its window and with the plugin beside this file.

``pvpython paraview_run.py IN.vtu OUT.vtu TARGET_COMPLEXITY [POINT_ARRAY ...]``
"""

from __future__ import annotations

import inspect
import sys
from pathlib import Path

# ParaView 5.11 asks for it, and Python 3.11 has it no more.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec  # type: ignore[attr-defined]

from paraview import simple

PLUGIN = Path(__file__).with_name("paraview_plugin.py")


def main(given: str, wanted: str, complexity: str, *arrays: str) -> None:
    """Load the plugin, read, adapt, and save the result."""
    simple.LoadPlugin(str(PLUGIN), remote=False)
    adapted = simple.AnistarAdapt(Input=simple.OpenDataFile(given))
    adapted.TargetComplexity = float(complexity)
    adapted.PointArrays = " ".join(arrays)
    adapted.UpdatePipeline()
    if adapted.GetDataInformation().GetNumberOfCells() == 0:
        raise SystemExit(f"{given} was not adapted; ParaView has printed why")
    simple.SaveData(wanted, adapted)


if __name__ == "__main__":
    main(*sys.argv[1:])
