"""How the gallery runs the solver examples: small, with a picture, where their package is."""

import importlib
import re
import shutil
import tempfile
from pathlib import Path

from PIL import Image, ImageFilter, ImageOps

from anistar.adapters import dolfinx_wheel

#: Arguments that make the examples small enough for every build of the documentation.
ARGUMENTS = {
    "advection_diffusion": "--complexities 500 1000 2000 --output {folder}/heat.vtu",
    "boundary_layer": "--dim 3 --complexities 500 1000 --sizes 8 13",
    "convection": "--complexities 125 250 500 --sizes 16 32",
    "cubic_reaction": "--dim 3 --complexities 500 1000 --sizes 8 13",
    "heat_sink": "--complexities 250 500 1000",
    "moving_front": "--complexity 400 --end 0.2 --steps 40 --output {folder}/series.pvd",
    "outflow_layers": "--complexities 500 1000 2000 --sizes 8 16",
    "plate_with_hole": "--complexities 250 500 1000 --lengths 0.16 0.08",
    "poisson": "--complexities 250 500 1000 2000",
    "reaction_diffusion": "",
    "rotating_cone": "--n-transfers 10 --size 0.04",
}

#: What each folder of examples needs: a package, or a program.
PACKAGES = {
    "scikit_fem": "skfem",
    "dolfinx": "dolfinx",
    "ngsolve": "ngsolve",
    "mfem": "mfem",
    "freefem": "FreeFem++",
    "petsc": "petsc4py",
    "transfer": "matplotlib",
}

#: Width and height of the thumbnails in pixels.
THUMBNAIL = (400, 280)

# What the examples write; it is gone when the documentation is built.
_FOLDER = tempfile.TemporaryDirectory(prefix="anistar-gallery-")


def runnable() -> str:
    """Return a pattern of the examples whose package is installed; the others are only shown."""
    dolfinx_wheel.make_importable()
    folders = [folder for folder, package in PACKAGES.items() if _is_installed(package)]
    return "|".join(re.escape(f"/{folder}/") for folder in folders) or "^$"


def _is_installed(package: str) -> bool:
    if shutil.which(package):
        return True
    try:
        importlib.import_module(package)
    except ImportError:
        return False
    return True


def _picture_of(name: str) -> Path:
    return Path(_FOLDER.name) / f"{name}.png"


def small_arguments(gallery_conf, script_vars):
    """Return the words after the program's name in the command line of an example."""
    # The gallery leaves out the name that scripts find the files beside them by.
    script_vars.get("example_globals", {})["__file__"] = script_vars["src_file"]
    name = Path(script_vars["src_file"]).stem
    given = ARGUMENTS[name].format(folder=_FOLDER.name).split()
    return [*given, "--picture", str(_picture_of(name))]


def drawn_picture(block, block_vars, gallery_conf):
    """Return reStructuredText that shows the picture an example has drawn, if it has."""
    from sphinx_gallery.scrapers import figure_rst

    drawn = _picture_of(Path(block_vars["src_file"]).stem)
    if not drawn.exists():
        return ""
    shown = next(block_vars["image_path_iterator"])
    shutil.move(drawn, shown)
    return figure_rst([shown], gallery_conf["src_dir"])


def draw_thumbnails(app):
    """Draw the thumbnails anew from their pictures, with lines that are still seen when small."""
    for thumbnail in Path(app.srcdir, "auto_examples").rglob("images/thumb/sphx_glr_*_thumb.png"):
        name = thumbnail.name.replace("_thumb.png", "_001.png")
        picture = thumbnail.parents[1] / name
        if picture.exists():
            _thumbnail_of(picture).save(thumbnail)


def _thumbnail_of(picture: Path) -> Image.Image:
    with Image.open(picture) as drawn:
        whole = drawn.convert("RGB")
    # The darkest of the pixels that fall into one: a mean of thin lines on white is nearly white.
    reach = max(whole.width // THUMBNAIL[0], whole.height // THUMBNAIL[1]) // 2 * 2 + 1
    return ImageOps.pad(whole.filter(ImageFilter.MinFilter(reach)), THUMBNAIL, color="white")


def with_anistar_in_petsc(gallery_conf, file_name):
    """Do what ``python -m anistar.adapters.petsc_program`` does before it runs a program."""
    name = Path(file_name).stem
    if name == "reaction_diffusion":
        from anistar.adapters import petsc

        petsc.register()
        petsc.PETSc.Options()["dm_adaptor"] = "anistar"
        petsc.PETSc.Options()["picture"] = str(_picture_of(name))
