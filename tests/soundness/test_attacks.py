"""What is false is refused, in the right words; what is true beside it is proved."""


def test_what_is_false_is_refused_and_what_is_true_is_proved():
    from tests.soundness.attacks import ATTACKS, REFUSALS

    assert len(ATTACKS) > 130
    wrong = []
    for one in ATTACKS:
        if one.true() is None:
            wrong.append(f"not proved, though it is true: {one.name}")
        try:
            one.false()
        except REFUSALS as reason:
            if one.refused not in str(reason):
                wrong.append(f"refused for another reason: {one.name}: {reason}")
        else:
            wrong.append(f"proved, though it is false: {one.name}")
    assert not wrong
