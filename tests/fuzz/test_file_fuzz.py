"""A sample of the fuzz of damaged files; ``run.py --files`` is the long one."""

from file_cases import differences, make_file_case
from file_mutations import MUTATIONS
from file_seeds import seeds
from fuzz_tables import FAILURES
from fuzz_workers import outcomes

from anistar import formats

N_CASES = 300
SEED = 7


def test_damaged_files_are_refused_with_their_name_or_give_what_they_held():
    rows = list(outcomes(range(N_CASES), seed=SEED, largest=None, timeout=60.0, mode="files"))
    assert len(rows) == N_CASES
    failed = [row for row in rows if row["verdict"] in FAILURES]
    assert [(row["number"], row["verdict"], row["message"]) for row in failed] == []
    assert 0.5 * N_CASES < sum(row["verdict"] == "refused" for row in rows) < N_CASES


def test_every_format_and_every_damage_has_its_turn():
    cases = [make_file_case(SEED, number) for number in range(N_CASES)]
    assert {case.kind for case in cases} == {name for name, _ in seeds()}
    assert {case.mutation for case in cases} == {mutate.__name__ for mutate in MUTATIONS}
    again = [make_file_case(SEED, number) for number in range(N_CASES)]
    assert [case.data for case in again] == [case.data for case in cases]


def test_the_judge_sees_what_is_lost(tmp_path):
    name, files = next((name, files) for name, files in seeds() if name.startswith("own .msh 6"))
    (tmp_path / "m.msh").write_bytes(files["m.msh"])
    whole = formats.read_with_report(tmp_path / "m.msh")
    mesh, fields, report = whole
    fewer = {key: field for key, field in fields.items() if key != "k"}
    formats.write(tmp_path / "n.mesh", mesh)
    plain = formats.read(tmp_path / "n.mesh")[0]
    assert name
    assert differences(whole, whole) == []
    assert differences(whole, (mesh, fewer, report)) == ["field k"]
    assert differences(whole, (type(mesh)(points=mesh.points, cells=mesh.cells), fields, report))
    assert differences(whole, (plain, fields, report)) == []
