"""The sketch of a mechanism: links between joints, signs of joints, axes, mass centres, ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.bodies import quartered
from linegraph.drawing.labels import Labels
from linegraph.drawing.letters import clean, width
from linegraph.drawing.poses import GROUND_LINK, Place, Poses, Tie, poses
from linegraph.drawing.scene import (
    ACCENT,
    GREY,
    INK,
    LARGE,
    PAPER,
    SMALL,
    Box,
    Disc,
    Item,
    Part,
    Pen,
    Point,
    Scene,
    Stroke,
    Text,
    arrow_head,
    line,
    moved,
    tenth,
)
from linegraph.drawing.svg import svg_text
from linegraph.drawing.symbols import (
    END_ON,
    capsule,
    carriage,
    ground_symbol,
    hatched,
    joint_symbol,
    tie_symbol,
)
from linegraph.drawing.views import chosen_view

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from linegraph.derive import Derivation
    from linegraph.vector import Vector

WIDE, HIGH, BORDER = 340, 270, 95
"""Room for the mechanism, which grows with the number of its joints, and around it for names."""

MORE, MOST, HIGHER = 14, 300, 1.4

TITLE = 24
SIGN, SIGN_HIGH = 56, 24
LONG_SIGNS = ("revolute", "prismatic", "cylindrical", "helical", "compound", "planar")
MOST_LISTED = 9
"""Names in a list below the sketch; all of them stand in its title."""

LINK_PEN, LINK_FILL = Pen("#6b7f96", 1.2), "#dde6f0"
SLIDES = ("prismatic", "cylindrical", "helical", "planar", "free")
"""Joints whose two frames may be apart."""

SHIFTED = ("revolute", "cylindrical", "helical", "prismatic")
ACTUATED = ("prismatic", "cylindrical", "helical")

SHIFTS = (0, -22, 22, -40, 40, -58, 58)
CLEAR = 20
"""A pin may stand anywhere on its axis: how far it is moved along it to be this far from others."""


def mechanism_scene(
    derivation: Derivation,
    q: Sequence[float] | None = None,
    hold: Mapping[str, float] | None = None,
) -> Scene:
    """A sketch of the mechanism at a configuration.

    Args:
        derivation: a derived model with bodies.
        q: the coordinates; those that close all loops, from the start values on, if left out.
        hold: coordinates that keep the value given while the loops are closed, by name.

    Raises:
        ModelError: a parameter has no value, or there are no bodies.
    """
    sketch = Sketch(poses(derivation, q, hold))
    title = f"Mechanism of {derivation.model.name}"
    items = moved(sketch.items, 16, 16)
    return Scene(sketch.width + 32, sketch.height + 32, title, sketch.about, items)


def mechanism_svg(derivation: Derivation, q: Sequence[float] | None = None) -> str:
    """`mechanism_scene` as SVG."""
    return svg_text(mechanism_scene(derivation, q))


class Sketch:
    """A mechanism drawn.

    Attributes:
        items: from the upper left corner.
        width, height: what they take.
        about: it in words.
    """

    def __init__(self, found: Poses) -> None:
        """Project and draw."""
        self.poses = found
        self.view = chosen_view(found)
        self._fit()
        self.labels = Labels(Box(0, TITLE, self.width, self.height))
        self.at: dict[str, Point] = {}
        self.points: dict[int, list[Point]] = {link: [] for link in found.links}
        for place in found.joints:
            self._seat(place)
        for tie in found.ties:
            if not tie.joint:
                self._attach(tie.links[0], self._seen(tie.tail))
                self._attach(tie.links[1], self._seen(tie.head))
        items: list[Item] = [Text(0, 13, "mechanism", LARGE, bold=True)]
        for step in (self._links, self._grounds, self._ties, self._joints, self._centers, self._triad):
            items += step()
        items += self._names()
        items += self._key()
        self.items = tuple(items)
        count = len(found.origins)
        self.about = f"{count} bodies, {len(found.joints)} joints that move"

    # ---- projection

    def _fit(self) -> None:
        """The scale, and where the origin of ground comes to stand."""
        flat = [self.view.seen(point) for point in self._extent()]
        left, right = min(x for x, _ in flat), max(x for x, _ in flat)
        low, high = min(y for _, y in flat), max(y for _, y in flat)
        more = min(MOST, MORE * max(0, len(self.poses.joints) - 4))
        spans = [(room + more) / span for room, span in ((WIDE, right - left), (HIGH, high - low)) if span > 1e-9]
        self.scale = min(spans, default=1.0)
        if (right - left) * self.scale < WIDE / 2:  # a high and narrow one has room to be higher
            self.scale *= HIGHER
        self.width = round((right - left) * self.scale) + 2 * BORDER
        self.height = round((high - low) * self.scale) + 2 * BORDER - 30
        self.origin = (BORDER - left * self.scale, BORDER - 15 + high * self.scale)

    def _extent(self) -> Iterator[Vector]:
        yield from (p for place in self.poses.joints for p in (place.tail, place.head))
        yield from self.poses.centers.values()
        yield from (p for tie in self.poses.ties for p in (tie.tail, tie.head))
        yield from list(self.poses.origins.values())[:1]

    def _seen(self, point: Vector) -> Point:
        x, y = self.view.seen(point)
        return (tenth(self.origin[0] + x * self.scale), tenth(self.origin[1] - y * self.scale))

    def _along(self, direction: Vector) -> Point:
        x, y = self.view.seen(direction)
        return (round(x, 9), -round(y, 9))

    # ---- what is where

    def _seat(self, place: Place) -> None:
        """Where a joint's sign stands: clear of others where it may be moved along its axis."""
        at = self._seen(place.head)
        axis = self._along(place.axis)
        if place.joint.kind in SHIFTED:
            for shift in SHIFTS:
                moved_to = (tenth(at[0] + shift * axis[0]), tenth(at[1] + shift * axis[1]))
                if all(_far(moved_to, other, CLEAR) for other in self.at.values()):
                    at = moved_to
                    break
        tail = self._seen(place.tail) if place.joint.kind in SLIDES else at
        if place.joint.kind in ACTUATED and GROUND_LINK not in place.links and _far(tail, at, 40):
            # between its ends, where a cylinder and its piston meet
            self._attach(place.links[0], tail)
            self._attach(place.links[1], at)
            at = tail = (tenth((tail[0] + at[0]) / 2), tenth((tail[1] + at[1]) / 2))
        self.at[place.joint.name] = at
        self._attach(place.links[0], tail)
        self._attach(place.links[1], at)

    def _attach(self, link: int, at: Point) -> None:
        if all(_far(at, other, 3) for other in self.points[link]):
            self.points[link].append(at)

    def _outline(self, link: int) -> list[Point]:
        """The points a link is drawn between: where it is connected, and its mass if that is at one place."""
        points = list(self.points[link])
        if len(points) < 2:
            center = self._center(link)
            if center is not None and all(_far(center, p, 3) for p in points):
                points.append(center)
        return points

    def _center(self, link: int) -> Point | None:
        center = self.poses.centers.get(link)
        return None if center is None else self._seen(center)

    # ---- drawing

    def _links(self) -> list[Item]:
        items: list[Item] = []
        for link, bodies in self.poses.links.items():
            points = self._outline(link)
            if link == GROUND_LINK or not points:
                continue
            hull = _hull(points)
            name = ", ".join(bodies)
            if len(hull) > 2:
                shape: list[Item] = [Stroke(hull[0], tuple((p,) for p in hull[1:]), LINK_PEN, True, LINK_FILL)]
                self.labels.along([*hull, hull[0]])
            else:
                shape = capsule(hull[0], hull[-1], 4.5, LINK_PEN, LINK_FILL)
                self.labels.along((hull[0], hull[-1]))
            center = self._center(link)
            if center is not None and not _inside(center, hull):
                near = min(points, key=lambda p: _distance2(p, center))
                shape.append(line(near, center, pen=Pen("#6b7f96", 1, (3, 2))))
            items.append(Part("body", name, tuple(shape), "body"))
        return items

    def _grounds(self) -> list[Item]:
        """A support wherever something is connected with ground."""
        items: list[Item] = []
        for place in self.poses.joints:
            if GROUND_LINK in place.links and place.joint.kind != "free":
                items += self._support(place)
        for tie in self.poses.ties:
            fixed = [p for link, p in zip(tie.links, (tie.tail, tie.head), strict=True) if link == GROUND_LINK]
            if fixed and not tie.joint and tie.kind in ("spring", "damper", "rod", "stop", "law", "friction", "edge"):
                x, y = self._seen(fixed[0])
                items += ground_symbol((x, y))
                self.labels.taken.append(Box(x - 16, y, x + 16, y + 20))
        return [Part("ground", "ground", tuple(items), "the reference")] if items else []

    def _support(self, place: Place) -> list[Item]:
        """Ground at a joint, on the side where its link is not."""
        (x, y), axis = self.at[place.joint.name], self._along(place.axis)
        length = (axis[0] ** 2 + axis[1] ** 2) ** 0.5
        if place.joint.kind == "prismatic" and length >= END_ON:
            self.labels.taken.append(Box(x - 24, y - 12, x + 24, y + 18))
            away = 13 if self._is_carriage(place) else 9
            return hatched((x, y), (axis[0] / length, axis[1] / length), away)
        every = [*self.at.values(), *(self._seen(c) for c in self.poses.centers.values())]
        below = sum(p[1] - y for p in every) <= 20 * len(every)
        sense = 1 if below else -1
        y += 8 * abs(axis[1]) * sense
        top, bottom = sorted((y, y + 20 * sense))
        self.labels.taken.append(Box(x - 16, top, x + 16, bottom))
        return ground_symbol((x, y), below)

    def _is_carriage(self, place: Place) -> bool:
        """Whether a slider is a body with another joint in its middle."""
        at = self.at[place.joint.name]
        x, y = self._along(place.axis)
        others = (
            self.at[p.joint.name]
            for p in self.poses.joints
            if p is not place and p.joint.kind != "prismatic"
        )
        return (
            place.joint.kind == "prismatic"
            and x * x + y * y >= END_ON * END_ON
            and any(not _far(at, other, 6) for other in others)
        )

    def _ties(self) -> list[Item]:
        items: list[Item] = []
        seen: dict[tuple[Point, Point], int] = {}
        ends = [(self._seen(tie.tail), self._seen(tie.head)) for tie in self.poses.ties]
        total = {pair: ends.count(pair) for pair in ends}
        for tie, (a, b) in zip(self.poses.ties, ends, strict=True):
            shape: list[Item] = []
            if tie.kind == "load":
                shape = _load(a)
            elif not tie.joint:
                k = seen[(a, b)] = seen.get((a, b), -1) + 1
                beside = 0 if tie.kind == "rod" else 16 * (k - (total[(a, b)] - 1) / 2)
                shape = tie_symbol(tie.kind, a, b, beside)
                self.labels.along((a, b))
            if shape:
                items.append(Part("tie", tie.name, tuple(shape), tie.kind))
        return items

    def _joints(self) -> list[Item]:
        items: list[Item] = []
        # a carriage stands behind what is joined to it
        for place in sorted(self.poses.joints, key=lambda place: not self._is_carriage(place)):
            at, axis = self.at[place.joint.name], self._along(place.axis)
            guide: list[Item] = []
            tail = self._seen(place.tail)
            if place.joint.kind in SLIDES and _far(tail, at, 12):
                pen = Pen(GREY, 1.2, (4, 3)) if place.joint.kind == "free" else Pen(GREY, 1.2)
                guide = [line(tail, at, pen=pen)]
                self.labels.along((tail, at))
            large = self._is_carriage(place)
            sign = carriage(at, axis) if large else joint_symbol(place.joint.kind, at, axis)
            about = f"{place.joint.kind}, {' → '.join(place.joint.between)}"
            items.append(Part("joint", place.joint.name, (*guide, *sign), about))
            self.labels.taken.append(Box(at[0] - 9, at[1] - 9, at[0] + 9, at[1] + 9))
            length = (axis[0] ** 2 + axis[1] ** 2) ** 0.5
            if length >= END_ON and place.joint.kind not in ("spherical", "universal", "free"):
                reach = 46 if large else 20
                dx, dy = reach * axis[0] / length, reach * axis[1] / length
                self.labels.along(((at[0] - dx, at[1] - dy), (at[0] + dx, at[1] + dy)))
        return items

    def _centers(self) -> list[Item]:
        items = []
        for link, center in self.poses.centers.items():
            x, y = self._seen(center)
            hidden = any(not _far((x, y), at, 8) for at in self.at.values())
            name = self.poses.links[link][0]
            shape = quartered(x, y, 3 if hidden else 5)
            items.append(Part("center", f"{name}.mass_center", shape, "mass centre"))
            self.labels.taken.append(Box(x - 5, y - 5, x + 5, y + 5))
        return list(items)

    def _triad(self) -> list[Item]:
        """The axes of ground, in the lower left corner."""
        x, y = 22, self.height - 24
        items: list[Item] = []
        for name, axis in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1))):
            dx, dy = self._along(axis)
            length = (dx * dx + dy * dy) ** 0.5
            if length < 0.2:
                items.append(Disc(x, y, 3, Pen(GREY, 1), PAPER))
                items.append(Text(x - 11, y + 12, name, SMALL, "middle", GREY))
                continue
            tip = (tenth(x + 24 * dx), tenth(y + 24 * dy))
            items += [
                line((x, y), tip, pen=Pen(GREY, 1.2)),
                arrow_head((x + 28 * dx, y + 28 * dy), (dx / length, dy / length), GREY, 6),
                Text(tenth(x + 37 * dx), tenth(y + 37 * dy + 3), name, SMALL, "middle", GREY),
            ]
        self.labels.taken.append(Box(x - 40, y - 44, x + 44, y + 24))
        return [Part("axes", "axes of ground", tuple(items))]

    # ---- names

    def _names(self) -> list[Item]:
        items: list[Item] = []
        for place in self.poses.joints:
            name = place.joint.name
            items += self.labels.place(name, self.at[name], color=ACCENT)
        for link, bodies in self.poses.links.items():
            if link != GROUND_LINK and bodies:
                more = f" (+{len(bodies) - 1})" if len(bodies) > 1 else ""
                items += self.labels.place(bodies[0] + more, self._middle(link), bold=True)
        for tie in self.poses.ties:
            if tie.kind == "load" or not tie.joint:
                (ax, ay), (bx, by) = self._seen(tie.tail), self._seen(tie.head)
                middle = (tenth((ax + bx) / 2), tenth((ay + by) / 2))
                items += self.labels.place(tie.name, middle, color=GREY)
        reach = max((box.right for box in self.labels.taken), default=0)
        self.width = max(self.width, round(reach) + 6)
        low = max((box.bottom for box in self.labels.taken), default=0)
        self.height = max(self.height, round(low) + 6)
        return items

    def _middle(self, link: int) -> Point:
        """Where a link's name points to: its mass centre, else its middle."""
        center = self._center(link)
        if center is not None:
            return center
        points = self._outline(link) or [self._seen(self.poses.origins[self.poses.links[link][0]])]
        count = len(points)
        return (tenth(sum(x for x, _ in points) / count), tenth(sum(y for _, y in points) / count))

    def _key(self) -> list[Item]:
        """Below the sketch: what is welded together, and what sits in joints."""
        lists: list[tuple[str, list[str]]] = []
        for link, bodies in self.poses.links.items():
            if link == GROUND_LINK and bodies:
                lists.append(("fixed to ground: ", bodies))
            elif len(bodies) > 1:
                lists.append((f"{bodies[0]} with ", bodies[1:]))
        lists.append(("fixed joints: ", self.poses.welds))
        inside = [f"{tie.name} ({_in_words(tie)})" for tie in self.poses.ties if tie.joint]
        lists.append(("in joints: ", inside))
        items: list[Item] = []
        for head, names in lists:
            shown = names if len(names) <= MOST_LISTED else names[: MOST_LISTED - 1]
            more = [f"and {len(names) - len(shown)} more"] if len(shown) < len(names) else []
            texts = []
            for words in _wrapped(head, [*shown, *more], self.width) if names else []:
                self.height += 14
                texts.append(Text(0, self.height, words, SMALL, color=GREY))
            if texts:
                self.width = max(self.width, *(width(t.text, SMALL) for t in texts))
                items.append(Part("key", head + ", ".join(names), tuple(texts)))
        self.height += 6
        signs = dict.fromkeys((place.joint.kind, self._is_carriage(place)) for place in self.poses.joints)
        return items + self._signs([kind for kind, large in signs if not large])

    def _signs(self, kinds: Sequence[str]) -> list[Item]:
        """What the signs of joints mean, each as it mostly stands in the picture."""
        items: list[Item] = []
        x = 0
        for kind in kinds:
            axes = [self._along(p.axis) for p in self.poses.joints if p.joint.kind == kind]
            end_on = all(x * x + y * y < END_ON * END_ON for x, y in axes)
            room = SIGN if kind in LONG_SIGNS and not end_on else SIGN // 2
            wide = room + width(kind, SMALL) + 14
            if x and x + wide > self.width:
                x, self.height = 0, self.height + SIGN_HIGH
            y = self.height + SIGN_HIGH // 2
            sign = joint_symbol(kind, (x + room / 2, y), (0, 0) if end_on else (1, 0))
            items += [*sign, Text(x + room + 4, y + 3.5, kind, SMALL, color=GREY)]
            x += wide
        self.height += SIGN_HIGH if kinds else 0
        return [Part("legend", "joints", tuple(items))] if items else []


def _in_words(tie: Tie) -> str:
    return f"{'port' if tie.kind == 'edge' else tie.kind} in {tie.joint}"


def _load(at: Point) -> list[Item]:
    """An arrow at the point that a load acts on."""
    x, y = at
    pen = Pen(ACCENT, 2)
    return [line((x - 30, y - 18), (x - 8, y - 5), pen=pen), arrow_head((x - 3, y - 2), (0.857, 0.514), ACCENT, 9)]


def _wrapped(head: str, names: Iterable[str], widest: int) -> list[str]:
    """Names in lines of no more than a width, as far as names allow."""
    lines, now = [], clean(head)
    for k, name in enumerate(names):
        word = clean(name)
        piece = word if k == 0 else f", {word}"
        if width(now + piece, SMALL) > widest and k:
            lines.append(now + ",")
            now = f"    {word}"
        else:
            now += piece
    return [*lines, now]


def _hull(points: Sequence[Point]) -> list[Point]:
    """The corners of the smallest convex outline, or the two ends where all are in a line."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered

    def half(row: Iterable[Point]) -> list[Point]:
        kept: list[Point] = []
        for p in row:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], p) <= 60:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    hull = half(ordered) + half(ordered[::-1])
    return hull if len(hull) > 2 else [ordered[0], ordered[-1]]


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _inside(p: Point, hull: Sequence[Point]) -> bool:
    """Whether a point is within an outline, or within a bar's width of its line."""
    if len(hull) > 2:
        return all(_turn(a, b, p) >= -60 for a, b in zip(hull, [*hull[1:], hull[0]], strict=True))
    a, b = hull[0], hull[-1]
    length2 = _distance2(a, b)
    t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length2 if length2 else 0
    t = min(max(t, 0), 1)
    return _distance2(p, (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))) < 25


def _distance2(a: Point, b: Point) -> float:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def _far(a: Point, b: Point, limit: float) -> bool:
    """Whether two points are apart by a distance, far from rounding's border."""
    return _distance2(a, b) > limit * limit + 1e-6
