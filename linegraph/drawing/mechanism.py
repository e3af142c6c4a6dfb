"""The sketch of a mechanism: links, symbols of joints, axes, mass centres, ground."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from linegraph.components.forces import POINT_FORCES
from linegraph.drawing.bodies import quartered
from linegraph.drawing.letters import clean, width
from linegraph.drawing.outline import distance2, far, hull_of, inside
from linegraph.drawing.poses import GROUND_LINK, JointPose, Poses, TiePose, poses
from linegraph.drawing.scene import (
    ACCENT,
    GREY,
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
from linegraph.drawing.stand import Stand
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

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from linegraph.numeric.derived import Derived

SIGN, SIGN_HIGH = 56, 24
MOST_LISTED = 9
"""Largest number of names in a list below the sketch; its title has all."""

HOLDING = ("spring", "damper", "rod", "stop", "law", "friction", "edge")
"""Ties that need a ground symbol where they end at ground."""

LINK_PEN, LINK_FILL = Pen("#6b7f96", 1.2), "#dde6f0"


def mechanism_scene(
    derivation: Derived,
    q: Sequence[float] | None = None,
    hold: Mapping[str, float] | None = None,
) -> Scene:
    """Sketch the mechanism at a configuration.

    Args:
        derivation: a derived model with bodies.
        q: coordinates (rad, m); if left out, those found from the start values that close all loops.
        hold: values of coordinates, by name, that are kept while the loops are closed.

    Raises:
        ModelError: a parameter has no value, or there are no bodies.
    """
    sketch = Sketch(poses(derivation, q, hold))
    title = f"Mechanism of {derivation.system.name}"
    items = moved(sketch.items, 16, 16)
    return Scene(sketch.width + 32, sketch.height + 32, title, sketch.about, items)


def mechanism_svg(derivation: Derived, q: Sequence[float] | None = None) -> str:
    """Sketch the mechanism as the text of an SVG file.

    Args:
        derivation: a derived model with bodies.
        q: coordinates, as for `mechanism_scene`.
    """
    return svg_text(mechanism_scene(derivation, q))


class Sketch(Stand):
    """The drawing of a mechanism.

    Attributes:
        items: the items, from the upper left corner.
        width, height: their size.
        about: description in words.
    """

    def __init__(self, found: Poses) -> None:
        """Project the poses and draw them."""
        super().__init__(found)
        self.middles: dict[str, Point] = {}
        items: list[Item] = [Text(0, 13, "mechanism", LARGE, bold=True)]
        for step in (
            self._links,
            self._grounds,
            self._ties,
            self._joints,
            self._centers,
            self._triad,
        ):
            items += step()
        items += self._names()
        items += self._key()
        self.items = tuple(items)
        count = len(found.origins)
        self.about = f"{count} bodies, {len(found.joints)} joints that move"

    # ---- drawing

    def _links(self) -> list[Item]:
        items: list[Item] = []
        for link, bodies in self.poses.links.items():
            points = self.outline(link)
            if link == GROUND_LINK or not points:
                continue
            hull = hull_of(points)
            name = ", ".join(bodies)
            if len(hull) > 2:
                shape: list[Item] = [
                    Stroke(hull[0], tuple((p,) for p in hull[1:]), LINK_PEN, True, LINK_FILL)
                ]
                self.labels.along([*hull, hull[0]])
            else:
                shape = capsule(hull[0], hull[-1], 4.5, LINK_PEN, LINK_FILL)
                self.labels.along((hull[0], hull[-1]))
            center = self.center(link)
            if center is not None and not inside(center, hull):
                near = min(points, key=lambda p: distance2(p, center))
                shape.append(line(near, center, pen=Pen("#6b7f96", 1, (3, 2))))
            items.append(Part("body", name, tuple(shape), "body"))
        return items

    def _grounds(self) -> list[Item]:
        """Ground symbols wherever something is connected to ground."""
        items: list[Item] = []
        base = self.poses.links[GROUND_LINK]
        bodies = self._base(base) if base else []
        for place in self.poses.joints:
            if GROUND_LINK in place.links and place.joint.kind != "free" and not base:
                items += self._support(place)
        supported = {self.at[p.joint.name] for p in self.poses.joints if GROUND_LINK in p.links}
        for tie in self.poses.ties:
            tail, head = self.seen(tie.tail), self.seen(tie.head)
            fixed, other = (tail, head) if tie.links[0] == GROUND_LINK else (head, tail)
            if GROUND_LINK in tie.links and tie.kind in HOLDING and not tie.joint:
                if fixed not in supported:
                    items += self._ground(fixed, other[1] <= fixed[1])
                supported.add(fixed)
        ground = [Part("ground", "ground", tuple(items), "the reference")] if items else []
        return [*bodies, *ground]

    def _base(self, bodies: Sequence[str]) -> list[Item]:
        """Bodies welded to ground, with a ground symbol at their frame."""
        foot = self.seen(self.poses.origins[bodies[0]])
        shape: list[Item] = []
        for point in self.points[GROUND_LINK]:
            if far(point, foot, 3):
                shape += capsule(foot, point, 4.5, LINK_PEN, LINK_FILL)
                self.labels.along((foot, point))
        body = Part("body", ", ".join(bodies), tuple(shape), "fixed to ground")
        return [body, Part("ground", "ground", tuple(self._ground(foot, True)), "the reference")]

    def _support(self, place: JointPose) -> list[Item]:
        """A ground symbol at a joint, on the side away from its link."""
        (x, y), axis = self.at[place.joint.name], self.along(place.axis)
        length = sqrt(axis[0] * axis[0] + axis[1] * axis[1])
        if place.joint.look.guided and length >= END_ON:
            self.labels.taken.append(Box(x - 24, y - 12, x + 24, y + 18))
            away = 13 if self.is_carriage(place) else 9
            return hatched((x, y), (axis[0] / length, axis[1] / length), away)
        tail = self.seen(place.tail if place.links[0] == GROUND_LINK else place.head)
        if place.joint.look.apart and far(tail, (x, y), 12):
            return self._ground(tail, True)
        every = [*self.at.values(), *(self.seen(c) for c in self.poses.centers.values())]
        below = sum(p[1] - y for p in every) <= 20 * len(every)
        return self._ground((x, y + 8 * abs(axis[1]) * (1 if below else -1)), below)

    def _ground(self, at: Point, below: bool) -> list[Item]:
        x, y = at
        top, bottom = (y, y + 20) if below else (y - 20, y)
        self.labels.taken.append(Box(x - 16, top, x + 16, bottom))
        return ground_symbol(at, below)

    def _ties(self) -> list[Item]:
        items: list[Item] = []
        seen: dict[tuple[Point, Point], int] = {}
        ends = [(self.seen(tie.tail), self.seen(tie.head)) for tie in self.poses.ties]
        total = {pair: ends.count(pair) for pair in ends}
        for tie, (a, b) in zip(self.poses.ties, ends, strict=True):
            shape: list[Item] = []
            if tie.kind in POINT_FORCES:
                shape = _load(a)
            elif not tie.joint:
                k = seen[(a, b)] = seen.get((a, b), -1) + 1
                beside = 0 if tie.kind == "rod" else 16 * (k - (total[(a, b)] - 1) / 2)
                shape = tie_symbol(tie.kind, a, b, beside)
                for edge in (-6, 0, 6):
                    self.labels.along(
                        (_shifted(a, a, b, beside + edge), _shifted(b, a, b, beside + edge))
                    )
                middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
                self.middles[tie.name] = _shifted(middle, a, b, beside)
            if shape:
                items.append(Part("tie", tie.name, tuple(shape), tie.kind))
        return items

    def _joints(self) -> list[Item]:
        items: list[Item] = []
        # A carriage is drawn first, so that the joints on it stay visible.
        for place in sorted(self.poses.joints, key=lambda place: not self.is_carriage(place)):
            at, axis = self.at[place.joint.name], self.along(place.axis)
            guide: list[Item] = []
            tail = self.seen(place.tail)
            if place.joint.look.apart and far(tail, at, 12):
                pen = Pen(GREY, 1.2, (4, 3)) if place.joint.look.loose else Pen(GREY, 1.2)
                guide = [line(tail, at, pen=pen)]
                self.labels.along((tail, at))
            large = self.is_carriage(place)
            sign = carriage(at, axis) if large else joint_symbol(place.joint.look.sign, at, axis)
            about = f"{place.joint.kind}, {' → '.join(place.joint.between)}"
            items.append(Part("joint", place.joint.name, (*guide, *sign), about))
            self.labels.taken.append(Box(at[0] - 9, at[1] - 9, at[0] + 9, at[1] + 9))
            length = sqrt(axis[0] * axis[0] + axis[1] * axis[1])
            if length >= END_ON and place.joint.look.directed:
                reach = 46 if large else 20
                dx, dy = reach * axis[0] / length, reach * axis[1] / length
                self.labels.along(((at[0] - dx, at[1] - dy), (at[0] + dx, at[1] + dy)))
        return items

    def _centers(self) -> list[Item]:
        items = []
        for link, center in self.poses.centers.items():
            x, y = self.seen(center)
            hidden = any(not far((x, y), at, 8) for at in self.at.values())
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
            dx, dy = self.along(axis)
            length = sqrt(dx * dx + dy * dy)
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
                items += self.labels.place(bodies[0] + more, self.middle(link), bold=True)
        for tie in self.poses.ties:
            if tie.kind in POINT_FORCES or not tie.joint:
                at = self.middles.get(tie.name, self.seen(tie.head))
                items += self.labels.place(tie.name, at, color=GREY)
        reach = max((box.right for box in self.labels.taken), default=0)
        self.width = max(self.width, round(reach) + 6)
        low = max((box.bottom for box in self.labels.taken), default=0)
        self.height = max(self.height, round(low) + 6)
        return items

    def _key(self) -> list[Item]:
        """Lists below the sketch: bodies welded together, and elements in joints."""
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
        signs = dict.fromkeys(
            (place.joint.kind, self.is_carriage(place)) for place in self.poses.joints
        )
        return items + self._signs([kind for kind, large in signs if not large])

    def _signs(self, kinds: Sequence[str]) -> list[Item]:
        """The legend of joints' symbols, each as it mostly appears in the picture."""
        items: list[Item] = []
        x = 0
        for kind in kinds:
            alike = [p for p in self.poses.joints if p.joint.kind == kind]
            axes, look = [self.along(p.axis) for p in alike], alike[0].joint.look
            end_on = all(x * x + y * y < END_ON * END_ON for x, y in axes)
            room = SIGN if look.long and not end_on else SIGN // 2
            wide = room + width(kind, SMALL) + 14
            if x and x + wide > self.width:
                x, self.height = 0, self.height + SIGN_HIGH
            y = self.height + SIGN_HIGH // 2
            sign = joint_symbol(look.sign, (x + room / 2, y), (0, 0) if end_on else (1, 0))
            items += [*sign, Text(x + room + 4, y + 3.5, kind, SMALL, color=GREY)]
            x += wide
        self.height += SIGN_HIGH if kinds else 0
        return [Part("legend", "joints", tuple(items))] if items else []


def _shifted(point: Point, a: Point, b: Point, beside: float) -> Point:
    """Move a point perpendicular to the line from a to b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = sqrt(dx * dx + dy * dy) or 1.0
    return (tenth(point[0] - dy / length * beside), tenth(point[1] + dx / length * beside))


def _in_words(tie: TiePose) -> str:
    return f"{'port' if tie.kind == 'edge' else tie.kind} in {tie.joint}"


def _load(at: Point) -> list[Item]:
    """An arrow at the point where a load acts."""
    x, y = at
    pen = Pen(ACCENT, 2)
    return [
        line((x - 30, y - 18), (x - 8, y - 5), pen=pen),
        arrow_head((x - 3, y - 2), (0.857, 0.514), ACCENT, 9),
    ]


def _wrapped(head: str, names: Iterable[str], widest: int) -> list[str]:
    """Break names into lines of a given width, as far as their lengths allow."""
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
