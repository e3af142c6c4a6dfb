"""Files and XML, with limits against hostile files: bytes in, plain elements with line numbers out.

Refused before the XML parser runs: anything but a regular file, more than 16 MiB, more markup than any
robot has, encodings in which checks of bytes are not reliable, and every DOCTYPE, because it can define
entities.
"""

from __future__ import annotations

import os
import re
import stat
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.readers.urdf.report import UrdfReport, shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import NoReturn

MOST_BYTES = 16 * 2**20
MOST_MARKUP = 200_000
"""Largest number of ``<`` and ``=``: limits elements and attributes, each of which takes 100 bytes or more.
"""
MOST_PREFIXES = 20
"""Largest number of undeclared namespace prefixes that are tolerated."""
DEEPEST = 64
"""Deepest nesting of elements; a URDF needs six levels."""
LONGEST_TEXT = 100
"""Number of characters of an element's text that are kept."""
WIDEST = 100
"""Largest number of attributes of an element; lxml takes time quadratic in it."""

# Subtrees without effect on the equations of motion.
_OPAQUE = frozenset({"visual", "collision", "sensor"})
# Supersets of ASCII only, so that the checks of bytes below see the same markup as the parser.
_ENCODINGS = frozenset(
    {"utf-8", "utf8", "us-ascii", "ascii", "iso-8859-1", "iso-8859-15", "latin1", "windows-1252"}
)
_XACRO = frozenset(
    {"http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro", "http://wiki.ros.org/xacro"}
)
_DECLARED = re.compile(rb"""<\?xml\s[^>]*?encoding\s*=\s*["']([^"'>]*)""")
_PROLOG = re.compile(rb"\s*(?:<\?.*?\?>\s*|<!--.*?-->\s*)*", re.DOTALL)
_ROOT_TAG = re.compile(_PROLOG.pattern + rb"<[^\s/>]+", re.DOTALL)
_DTD_REFUSED = (
    "has a DOCTYPE, which can define entities that read other files or grow without bound; "
    "delete it, a URDF needs none"
)
_UTF8 = "; save the file as UTF-8"


class XmlElement(NamedTuple):
    """An XML element.

    Attributes:
        tag: the name, with its prefix if it has one: ``link``, ``xacro:include``.
        line: counted from 1; the last one for a tag over several lines.
        attributes: values by name; those in a namespace as ``{namespace}name``.
        children: elements inside, without comments; empty for parts that are not read.
        text: beginning of the text inside; URDF uses attributes only, extensions do not.
    """

    tag: str
    line: int
    attributes: Mapping[str, str]
    children: tuple[XmlElement, ...]
    text: str = ""


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Read a regular file.

    Raises:
        SourceError: it is missing, unreadable, no regular file or over 16 MiB.
    """
    report = UrdfReport(os.fsdecode(path))
    try:
        _require_regular(os.stat(path), report)
        # Without O_NONBLOCK, opening a FIFO that has replaced the file since the check would block forever.
        flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        with open(os.open(path, flags), "rb") as file:
            _require_regular(os.fstat(file.fileno()), report)
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise report.error(None, "", f"cannot be read: {error.strerror}") from None
    except ValueError as error:  # a NUL in the path
        raise report.error(None, "", f"cannot be read: {error}") from None
    return data


def parse_xml(data: bytes, report: UrdfReport) -> XmlElement:
    """Parse an XML document and return its root element.

    Args:
        data: the bytes of the file.
        report: receives warnings and places errors.

    Raises:
        SourceError: it is not XML, or is XML of a kind that is refused.
    """
    data = _checked(data, report)
    root = _parsed(data, report)
    if root.getroottree().docinfo.internalDTD is not None:
        raise report.error(1, "", _DTD_REFUSED)
    return _converted(root, report, 1, 1)


def _require_regular(status: os.stat_result, report: UrdfReport) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise report.error(None, "", "is a directory; a URDF file is needed")
    if not stat.S_ISREG(status.st_mode):
        raise report.error(None, "", "is not a regular file")


def _checked(data: bytes, report: UrdfReport) -> bytes:
    """Check that a parser may read the bytes; return them without byte order mark."""
    if len(data) > MOST_BYTES:
        raise report.error(None, "", f"is over {MOST_BYTES // 2**20} MiB, more than is read")
    if data.startswith((b"\xff\xfe", b"\xfe\xff", b"\x00\x00\xfe\xff")):
        raise report.error(1, "", f"is UTF-16 or UTF-32{_UTF8}")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\x00" in data:
        line = _line_at(data, data.index(b"\x00"))
        raise report.error(line, "", f"holds NUL bytes: it is UTF-16 or no text{_UTF8}")
    if not data.strip():
        raise report.error(None, "", "is empty")
    if data.count(b"<") + data.count(b"=") > MOST_MARKUP:
        raise report.error(None, "", f"holds more than {MOST_MARKUP} tags and attributes")
    _require_encoding(data, report)
    _require_plain_start(data, report)
    return data


def _require_encoding(data: bytes, report: UrdfReport) -> None:
    declared = _DECLARED.match(data)
    encoding = declared[1].decode("ascii", "replace").lower() if declared else "utf-8"
    if encoding not in _ENCODINGS:
        raise report.error(1, "", f'declares the encoding "{shown(encoding)}"{_UTF8}')
    if encoding in ("utf-8", "utf8"):
        try:
            data.decode()
        except UnicodeDecodeError as error:
            line = _line_at(data, error.start)
            problem = f"byte 0x{data[error.start]:02x} is not UTF-8: another encoding, or no text"
            raise report.error(line, "", problem + _UTF8) from None


def _require_plain_start(data: bytes, report: UrdfReport) -> None:
    """Refuse a DOCTYPE; it can only follow the prolog."""
    found = _PROLOG.match(data)
    start = found.end() if found else 0
    line = _line_at(data, start)
    begins = data[start : start + 200].lower()
    if begins.startswith((b"<!doctype html", b"<html")):
        raise report.error(line, "", "looks like an HTML page, not a URDF")
    if begins.startswith(b"<!doctype"):
        raise report.error(line, "", _DTD_REFUSED)
    if not begins.startswith(b"<"):
        text = shown(data[start : start + 40].decode("utf-8", "replace").split("\n")[0], 30)
        raise report.error(line, "", f'is not XML: it begins with "{text}"')


def _line_at(data: bytes, offset: int) -> int:
    return data.count(b"\n", 0, offset) + 1


def _parsed(data: bytes, report: UrdfReport) -> Any:
    """Parse with lxml, tolerating undeclared namespace prefixes.

    Some tools write prefixes without declaring them. They are declared in a second pass instead of using a
    recovering parser, which would ignore other errors of the file, too.
    """
    from lxml import etree  # imported here: other commands need not wait for it

    undefined = etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE
    prefixes: dict[str, int] = {}
    while True:
        parser = _parser()
        try:
            root = etree.fromstring(_declaring(prefixes, data), parser)
        except etree.XMLSyntaxError as error:
            errors = list(parser.error_log)
            others = [e for e in errors if e.type != undefined]
            if others or not errors:
                _refuse(error, others, report)
            before = len(prefixes)
            for e in errors:
                prefixes.setdefault(_prefix(e.message), e.line)
            if not before < len(prefixes) <= MOST_PREFIXES or "" in prefixes:
                _refuse(error, errors, report)
            continue
        if prefixes:
            names = shown(", ".join(sorted(prefixes)), 200)
            text = f"undeclared namespace prefixes ({names}); what has them is ignored"
            report.warn(min(prefixes.values()), "XML", text)
        return root


def _parser() -> Any:
    from lxml import etree

    # URDF needs no entities, DTDs or network; each of them would let a file read others or grow without
    # bound.
    return etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )


def _prefix(message: str) -> str:
    """The prefix named by an error; empty if it cannot be declared in every encoding."""
    found = re.match(r"Namespace prefix ([A-Za-z0-9_.-]+) ", message)
    return found[1] if found else ""


def _declaring(prefixes: Iterable[str], data: bytes) -> bytes:
    """Declare prefixes in the root element without changing line numbers."""
    declarations = "".join(f' xmlns:{prefix}="undeclared:{prefix}"' for prefix in prefixes)
    found = _ROOT_TAG.match(data)
    end = found.end() if found else 0
    return data[:end] + declarations.encode() + data[end:]


def _refuse(error: Any, errors: list[Any], report: UrdfReport) -> NoReturn:
    """Raise the first error; later ones are mostly its consequences."""
    line, message = (errors[0].line, errors[0].message) if errors else (error.lineno, error.msg)
    plain = re.sub(r", (use|try) XML_PARSE_HUGE.*", "", " ".join(str(message).split()))
    raise report.error(line or None, "XML", shown(plain, 200)) from None


def _converted(node: Any, report: UrdfReport, depth: int, parent_line: int) -> XmlElement:
    # Beyond line 65535 libxml2 knows the lines of elements with text only; others inherit their parent's.
    line = max(node.sourceline or 1, parent_line)
    if depth > DEEPEST:
        raise report.error(line, "XML", f"elements are nested more than {DEEPEST} deep")
    if len(node.attrib) > WIDEST:
        raise report.error(line, "XML", f"an element has more than {WIDEST} attributes")
    tag = _tag(node)
    children: tuple[XmlElement, ...] = ()
    if tag not in _OPAQUE:
        elements = (child for child in node if isinstance(child.tag, str))
        children = tuple(_converted(child, report, depth + 1, line) for child in elements)
    text = (node.text or "")[:LONGEST_TEXT].strip()
    return XmlElement(tag, line, dict(node.items()), children, text)


def _tag(node: Any) -> str:
    """The name as written; elements of xacro always have the prefix xacro."""
    namespace, _, local = node.tag.rpartition("}")
    if namespace[1:] in _XACRO:
        return f"xacro:{local}"
    return f"{node.prefix}:{local}" if node.prefix else str(local)
