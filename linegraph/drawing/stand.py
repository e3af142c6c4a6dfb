"""Positions in the sketch: view, scale, joints moved apart, and links between joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.labels import LONGEST_LABEL, Labels
from linegraph.drawing.letters import short, width
from linegraph.drawing.outline import far
from linegraph.drawing.poses import GROUND_LINK, JointPose, Poses
from linegraph.drawing.scene import NORMAL, Box, Point, tenth
from linegraph.drawing.symbols import END_ON
from linegraph.drawing.views import chosen_view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.spatial.vector import Vector

WIDE, HIGH, BORDER, MOST_BORDER = 340, 270, 95, 170
"""Space for the mechanism, which grows with the number of its joints, and around it for names."""

MORE, MOST, LARGER = 14, 300, 1.4

TITLE = 24
SHIFTS = (0, -22, 22, -40, 40, -58, 58)
CLEAR = 20
"""Least distance between symbols; a pin may be moved along its axis to keep it."""


class Stand:
    """A mechanism placed in the picture, before drawing.

    Attributes:
        poses, view: the mechanism and the view.
        width, height: size so far.
        labels: areas for names.
        at: positions of the joints' symbols.
        points: points where each link is connected.
    """

    def __init__(self, found: Poses) -> None:
        """Choose view and scale, and place joints and ties."""
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
                self._attach(tie.links[0], self.seen(tie.tail))
                self._attach(tie.links[1], self.seen(tie.head))

    def _fit(self) -> None:
        """Choose the scale and the position of ground's origin."""
        flat = [self.view.seen(point) for point in self._extent()]
        left, right = min(x for x, _ in flat), max(x for x, _ in flat)
        low, high = min(y for _, y in flat), max(y for _, y in flat)
        more = min(MOST, MORE * max(0, len(self.poses.joints) - 4))
        spans = [
            (room + more) / span
            for room, span in ((WIDE, right - left), (HIGH, high - low))
            if span > 1e-9
        ]
        self.scale = min(spans, default=1.0)
        if min((right - left) * self.scale / WIDE, (high - low) * self.scale / HIGH) < 0.5:
            self.scale *= LARGER  # a slender mechanism leaves space
        names = [place.joint.name for place in self.poses.joints] + [*self.poses.origins]
        widest = max(width(short(name, LONGEST_LABEL), NORMAL, bold=True) for name in names)
        beside = min(MOST_BORDER, max(BORDER, widest + 30))
        self.width = int((right - left) * self.scale) + 2 * beside
        self.height = int((high - low) * self.scale) + 2 * BORDER - 30
        self.origin = (beside - left * self.scale, BORDER - 15 + high * self.scale)

    def _extent(self) -> Iterator[Vector]:
        yield from (p for place in self.poses.joints for p in (place.tail, place.head))
        yield from self.poses.centers.values()
        yield from (p for tie in self.poses.ties for p in (tie.tail, tie.head))
        yield from list(self.poses.origins.values())[:1]

    def seen(self, point: Vector) -> Point:
        """Position of a point of the mechanism in the picture."""
        x, y = self.view.seen(point)
        return (tenth(self.origin[0] + x * self.scale), tenth(self.origin[1] - y * self.scale))

    def along(self, direction: Vector) -> Point:
        """A direction in the picture; shorter than 1 if it is not parallel to the picture."""
        x, y = self.view.seen(direction)
        return (round(x, 9), -round(y, 9))

    def _seat(self, place: JointPose) -> None:
        """Place a joint's symbol, moved along its axis if others are too close."""
        at = self.seen(place.head)
        axis = self.along(place.axis)
        if place.joint.look.shifted:
            for shift in SHIFTS:
                moved_to = (tenth(at[0] + shift * axis[0]), tenth(at[1] + shift * axis[1]))
                if all(far(moved_to, other, CLEAR) for other in self.at.values()):
                    at = moved_to
                    break
        tail = self.seen(place.tail) if place.joint.look.apart else at
        if place.joint.look.actuated and GROUND_LINK not in place.links and far(tail, at, 40):
            # In the middle between its ends, where cylinder and piston meet.
            self._attach(place.links[0], tail)
            self._attach(place.links[1], at)
            at = tail = (tenth((tail[0] + at[0]) / 2), tenth((tail[1] + at[1]) / 2))
        self.at[place.joint.name] = at
        self._attach(place.links[0], tail)
        self._attach(place.links[1], at)

    def _attach(self, link: int, at: Point) -> None:
        if all(far(at, other, 3) for other in self.points[link]):
            self.points[link].append(at)

    def outline(self, link: int) -> list[Point]:
        """Points that span a link: its connections, and its mass centre if it has only one connection."""
        points = list(self.points[link])
        if len(points) < 2:
            center = self.center(link)
            if center is not None and all(far(center, p, 3) for p in points):
                points.append(center)
        return points

    def center(self, link: int) -> Point | None:
        """A link's mass centre in the picture; None without mass."""
        center = self.poses.centers.get(link)
        return None if center is None else self.seen(center)

    def is_carriage(self, place: JointPose) -> bool:
        """Whether a slider is a body with another joint in its middle."""
        at = self.at[place.joint.name]
        x, y = self.along(place.axis)
        others = (
            self.at[p.joint.name]
            for p in self.poses.joints
            if p is not place and not p.joint.look.guided
        )
        return (
            place.joint.look.guided
            and x * x + y * y >= END_ON * END_ON
            and any(not far(at, other, 6) for other in others)
        )

    def middle(self, link: int) -> Point:
        """The point that a link's name refers to: its mass centre, else its middle."""
        center = self.center(link)
        if center is not None:
            return center
        points = self.outline(link) or [self.seen(self.poses.origins[self.poses.links[link][0]])]
        count = len(points)
        return (tenth(sum(x for x, _ in points) / count), tenth(sum(y for _, y in points) / count))
