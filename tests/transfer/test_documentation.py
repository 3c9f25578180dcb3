from documents import code_blocks, run_script


def test_the_code_of_the_page_runs(tmp_path):
    (code,) = code_blocks("docs/transfer.md", "python")
    assert run_script(tmp_path, code).startswith("[0.0")
