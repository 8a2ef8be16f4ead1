"""Jumps that are decided at run time: what they may jump over, or run again, is left out and told."""

import pytest

from beltgrinding.programs.registry import read_program

RAPID = """MODULE M
FUNC robtarget at(num x) RETURN [[x,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; ENDFUNC
VAR num n:=0;
PROC main()
{}
ENDPROC
ENDMODULE
"""
AS = """.PROGRAM p()
{}
.END
"""


def rapid(folder, *lines):
    path = folder / "p.mod"
    move = "MoveL at({}),v100,fine,tool0;"
    rows = [move.format(row[5:]) if row.startswith("move ") else row for row in lines]
    path.write_text(RAPID.format("\n".join(rows)))
    return read_program(path)


def kawasaki(folder, *lines):
    path = folder / "p.as"
    move = "LMOVE TRANS({},0,0,0,0,0)"
    rows = [move.format(row[5:]) if row.startswith("move ") else row for row in lines]
    path.write_text(AS.format("\n".join(rows)))
    return read_program(path)


def places(program):
    """x of every motion, None where motions are left out."""
    return [None if m.pose is None else m.pose[0, 3] for m in program.motions]


def codes(program):
    kept = ("programs.path_speed_unknown",)
    return [problem.code for problem in program.problems if problem.code not in kept]


AT_RUN_TIME = "programs.decided_at_run_time"
BRANCHES = {
    rapid: [["IF di1=1 GOTO over;"], ["IF di1=1 THEN", "GOTO over;", "ENDIF"]],
    kawasaki: [["IF SIG(1) GOTO over"], ["IF SIG(1) THEN", "GOTO over", "END"]],
}
CASES = [(read, branch) for read, branches in BRANCHES.items() for branch in branches]
END = {rapid: ";", kawasaki: ""}


@pytest.mark.parametrize("read, branch", CASES)
def test_what_a_jump_may_pass_over_is_left_out(tmp_path, read, branch):
    program = read(tmp_path, "move 1", *branch, "move 2", "move 3", "over:", "move 4")
    assert places(program) == [1, None, 4]
    assert codes(program) == [AT_RUN_TIME]


@pytest.mark.parametrize("read, branch", CASES)
def test_what_a_jump_may_run_again_is_told(tmp_path, read, branch):
    program = read(tmp_path, "over:", "move 1", *branch, "move 2")
    assert places(program) == [1, None, 2]
    assert codes(program) == [AT_RUN_TIME]


@pytest.mark.parametrize("read, branch", CASES)
def test_a_jump_within_what_may_be_passed_over_counts(tmp_path, read, branch):
    goto = "GOTO far" + END[read]
    program = read(tmp_path, "move 1", *branch, "move 2", goto, "over:", "move 3", "far:", "move 4")
    assert places(program) == [1, None, 4]
    assert codes(program) == [AT_RUN_TIME]


def test_two_jumps_of_a_branch_reach_to_the_further_label(tmp_path):
    branch = ["IF di1=1 THEN", "GOTO a;", "ELSE", "GOTO b;", "ENDIF"]
    program = rapid(tmp_path, "move 1", *branch, "move 2", "a:", "move 3", "b:", "move 4")
    assert places(program) == [1, None, 4]


def test_a_jump_out_of_a_block_passes_over_its_rest(tmp_path):
    loop = ["FOR i FROM 1 TO 2 DO", "move 2", "IF di1=1 GOTO over;", "move 3", "ENDFOR"]
    program = rapid(tmp_path, "move 1", *loop, "move 4", "over:", "move 5")
    assert places(program)[:2] == [1, 2] and places(program)[-2:] == [None, 5]
    assert set(codes(program)) == {AT_RUN_TIME}
    assert 3 not in places(program) and 4 not in places(program)


def test_a_jump_to_no_label_is_told(tmp_path):
    program = rapid(tmp_path, "move 1", "IF di1=1 GOTO nowhere;", "move 2")
    assert places(program)[:2] == [1, None] and 2 not in places(program)
    assert codes(program) == [AT_RUN_TIME, "programs.no_label"]


@pytest.mark.parametrize("read", BRANCHES)
def test_a_known_jump_back_is_followed_as_often_as_it_is_taken(tmp_path, read):
    up = {rapid: "n:=n+1;", kawasaki: "n = n+1"}[read]
    back = {rapid: "IF n<3 GOTO again;", kawasaki: "IF n<3 GOTO again"}[read]
    begin = {rapid: "n:=0;", kawasaki: "n = 0"}[read]
    program = read(tmp_path, begin, "again:", "move n", up, back, "move 9")
    assert places(program) == [0, 1, 2, 9]
    assert not codes(program)


def test_a_short_if_whose_jump_is_not_taken_goes_on(tmp_path):
    program = rapid(tmp_path, "move 1", "IF n=5 GOTO over;", "move 2", "over:", "move 3")
    assert places(program) == [1, 2, 3] and not codes(program)
