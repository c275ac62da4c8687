"""An interrupt ends a call on its way, and the next call is heard as ever."""

import os
import signal

import hovertone
import pytest
from testkit import RATE_HZ, rotor


def test_an_interrupt_ends_a_call():
    sound = rotor(61.3, 60.0)
    shares = []

    def interrupt(share):
        shares.append(share)
        if share > 0.1 and len(shares) > 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        hovertone.speed(sound, rate_hz=RATE_HZ, blades=2, progress=interrupt)
    assert 0.1 < shares[-1] < 0.9, shares
    assert hovertone.speed(sound[: 5 * RATE_HZ], rate_hz=RATE_HZ, blades=2).status == "ok"


def test_what_a_listener_raises_ends_the_call():
    shares = []

    def listener(share):
        shares.append(share)
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        hovertone.speed("hover.wav", blades=2, progress=listener)
    assert len(shares) == 1
