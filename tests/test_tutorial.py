"""The tutorial's blocks of code form one script that runs."""

from documents import code_blocks, run_script

import anistar


def test_the_blocks_of_the_tutorial_run_in_order_and_write_a_valid_mesh(tmp_path):
    run_script(tmp_path, "\n\n".join(code_blocks("docs/tutorial.md", "python")))
    mesh, fields = anistar.read(tmp_path / "layer.vtu")
    assert anistar.validate(mesh) == []
    assert set(fields) == {"u"}
    assert mesh.names == {(1, 1): "bottom", (1, 2): "top"}
