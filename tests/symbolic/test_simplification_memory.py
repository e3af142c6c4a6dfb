"""What calculating objects have come to know is forgotten whole."""

from __future__ import annotations

from typing import Any

from linegraph.symbolic.simplification.memory import Memory


class Calculating:
    """Something that learns."""

    def __init__(self) -> None:
        """Know one thing of each kind."""
        self.known: dict[str, int] = {"a": 1}
        self.found: list[int] = [1]
        self.work = 3
        self.name = "first"


def test_lists_dicts_and_others_have_their_values_back() -> None:
    x = Calculating()
    memory = Memory(x)
    x.known["b"] = 2
    del x.known["a"]
    x.found.append(7)
    x.work += 5
    x.name = "second"
    memory.restore()
    assert (x.known, x.found, x.work, x.name) == ({"a": 1}, [1], 3, "first")


def test_lists_and_dicts_stay_the_objects_that_others_hold() -> None:
    x = Calculating()
    known, found = x.known, x.found
    memory = Memory(x)
    x.known = {"other": 9}
    x.found = [9, 9]
    known["b"] = 2
    memory.restore()
    assert x.known is known
    assert x.found is found
    assert (known, found) == ({"a": 1}, [1])


def test_what_is_restored_twice_stays_restored() -> None:
    x, y = Calculating(), Calculating()
    memory = Memory(x, y)
    for _ in range(2):
        x.found.append(2)
        y.known.clear()
        memory.restore()
        assert (x.found, y.known) == ([1], {"a": 1})


def test_objects_in_lists_are_kept_as_they_are() -> None:
    inner: list[Any] = []
    x = Calculating()
    x.found = [inner]  # type: ignore[list-item]
    memory = Memory(x)
    inner.append(1)
    memory.restore()
    assert x.found == [[1]]
