"""What is false is refused, in the right words; what is true beside it is proved."""


def test_what_is_false_is_refused_and_what_is_true_is_proved():
    from tests.soundness.attacks import ATTACKS, REFUSALS

    assert len(ATTACKS) > 130
    wrong = []
    for attack in ATTACKS:
        if attack.true() is None:
            wrong.append(f"not proved, though it is true: {attack.name}")
        try:
            attack.false()
        except REFUSALS as reason:
            if attack.refused not in str(reason):
                wrong.append(f"refused for another reason: {attack.name}: {reason}")
        else:
            wrong.append(f"proved, though it is false: {attack.name}")
    assert not wrong
