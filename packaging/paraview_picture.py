"""Show what ParaView has adapted, cut open.

``pvbatch paraview_picture.py IN.vtu OUT.png``
"""

import sys

from paraview import simple


def main(given: str, picture: str) -> None:
    """Cut the mesh at a plane, along whole cells, and save what is behind it."""
    view = simple.CreateView("RenderView")
    view.ViewSize = [720, 540]
    view.OrientationAxesVisibility = 0
    part = simple.Clip(Input=simple.OpenDataFile(given), Crinkleclip=1)
    part.ClipType.Origin = [0.5, 0.3, 0.5]
    part.ClipType.Normal = [0.0, 1.0, 0.0]
    part.Invert = 1
    shown = simple.Show(part, view)
    shown.SetRepresentationType("Surface With Edges")
    shown.EdgeColor = [0.15, 0.18, 0.22]
    shown.Ambient, shown.Diffuse = 0.45, 0.6
    simple.ColorBy(shown, ("POINTS", "u"))
    simple.GetColorTransferFunction("u").ApplyPreset("Cool to Warm", True)
    simple.ResetCamera(view)
    camera = view.GetActiveCamera()
    camera.SetPosition(1.3, 3.6, 1.6)
    camera.SetFocalPoint(0.5, 0.5, 0.5)
    camera.SetViewUp(0, 0, 1)
    simple.ResetCamera(view)
    camera.Zoom(1.25)
    simple.SaveScreenshot(
        picture, view, OverrideColorPalette="WhiteBackground", CompressionLevel="9"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
