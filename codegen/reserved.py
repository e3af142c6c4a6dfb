"""Words that emitted code cannot have as names, as a language or a library has them already."""

from __future__ import annotations

import re


def _words(*texts: str) -> frozenset[str]:
    return frozenset(word for text in texts for word in text.split())


_C = """
    auto break case char const continue default do double else enum extern float for goto if
    inline int long register restrict return short signed sizeof static struct switch typedef
    union unsigned void volatile while alignas alignof bool constexpr false nullptr
    static_assert thread_local true typeof typeof_unqual asm fortran
"""
_CPP = """
    and and_eq atomic_cancel atomic_commit atomic_noexcept bitand bitor catch char16_t char32_t
    char8_t class co_await co_return co_yield compl concept const_cast consteval constinit
    decltype delete dynamic_cast explicit export friend mutable namespace new noexcept not
    not_eq operator or or_eq private protected public reflexpr reinterpret_cast requires
    static_cast synchronized template this throw try typeid typename using virtual wchar_t xor
    xor_eq
"""
_PYTHON = """
    False None True as assert async await def del elif except finally from global import in is
    lambda nonlocal pass raise with yield
"""
KEYWORDS = _words(_C, _CPP, _PYTHON)
"""Reserved words of C, C++ and Python."""

_MACROS = """
    alloca BIG_ENDIAN BYTE_ORDER DOMAIN fpclassify i386 INFINITY iscanonical iseqsig isfinite
    isgreater isgreaterequal isinf isless islessequal islessgreater isnan isnormal issignaling
    issubnormal isunordered iszero linux LITTLE_ENDIAN math_errhandling MAXFLOAT NAN NFDBITS
    NULL OVERFLOW PDP_ENDIAN PLOSS RAND_MAX signbit SING TLOSS UNDERFLOW unix
"""
MACROS = _words(_MACROS)
"""Macros that the compiler or <math.h>, with all that it includes, defines on some platform."""

MACRO_FAMILIES = re.compile(
    r"(FP_|HUGE_VAL|MATH_ERR|SNAN|FD_|EXIT_|MB_CUR_|W[A-Z]+$|[bl]e(16|32|64)toh$|hto[bl]e(16|32|64)$"
    r"|M_(1_PI|2_PI|2_SQRTPI|E|LN2|LN10|LOG2E|LOG10E|PI|PI_2|PI_4|SQRT2|SQRT1_2)(f|l|f\d+x?)?$)"
)
"""More of them, by how they begin."""

_HEADERS = """
    assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal
    stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn string tgmath
    threads time uchar wchar wctype
"""
_MODULES = """
    abc ast bisect builtins codecs collections concurrent contextlib contextvars copy copyreg
    csv ctypes datetime dis enum fnmatch fractions functools gc genericpath glob hashlib hmac
    importlib inspect io itertools json keyword linecache logging mmap ntpath numbers numpy
    opcode operator os pathlib pickle platform posixpath pprint queue random re reprlib secrets
    selectors shutil site socket stat struct subprocess sys sysconfig tempfile textwrap
    threading token tokenize traceback types typing unicodedata unittest urllib uuid warnings
    weakref zipfile zipimport conftest pytest _pytest
"""
FILES = _words(_HEADERS, _MODULES)
"""Headers of C and modules that NumPy imports: a file of that name would be taken for them."""

_BOARDS = """
    AS2 F_CPU PI PM SE SP XH XL YH YL ZH ZL
"""
BOARDS = re.compile(
    r"[A-Z]{3}[A-Z0-9_]*|[A-Z]{2}_[A-Z0-9_]*|[A-Z]{2}\d[A-Z][A-Z0-9]*|A\d|A1[0-5]|B[01]{1,8}"
    r"|(P[A-L]|CS|DD|DT|FE|SM|TC)\d+|U2X\d|E2[A-Z]+|(PRI|SCN)[dioux]\w+|\w+_vect(_num)?"
    rf"|{'|'.join(_BOARDS.split())}"
)
"""What Arduino.h replaces on some board, or may: constants, pins, registers and their bits.

There are thousands, which differ from board to board. Nearly all have three capitals or more and no small
letter, so that whatever is written like this is none of ours there.
"""

_CORES = """
    Arduino ArduinoGraphics binary Bridge CAN CDC Client EEPROM Esplora Ethernet Firmata HardwareSerial HID
    IPAddress Keyboard LiquidCrystal Mouse MSC pgmspace PluggableUSB Print Printable SD Server Servo
    SoftwareSerial SPI Stepper Stream Temboo TFT UART Udp USB USBAPI USBCore USBDesc WCharacter WiFi Wire
    wiring_private WMath WString pins_arduino
"""
CORES = frozenset(word.casefold() for word in _CORES.split())
"""Headers of Arduino's cores and of the libraries that come with them, in small letters.

On systems that take capitals for small letters a file ``servo.h`` is found as ``Servo.h``, too.
"""

HEADS = _words(
    "H HIGH1 HIGH2 HIGH4 LANES LOW1 LOW2 LOW4 PART RESTRICT SWAP", "TEST_NO_STDIO TEST_REAL"
)
"""Names of macros of the emitted C files, without the prefix."""

CLASS = _words("replace self")
"""Names that the emitted Python class `Parameters` uses itself."""

_OWN = """
    all angle angles any bool check common cosines count DEFAULT_PARAMETERS default_parameters
    enumerate float H isinstance join kept lead len list main n np NQ NU number NV object other
    Parameters parameters Q_NAMES q_names shape sines split status type U_NAMES u_names V_NAMES
    v_names zero
"""
_MATH = """
    acos asin atan atan2 ceil cos cosh erf erfc exp fabs floor fmod frexp gamma hypot j0 j1 jn
    ldexp lgamma log log10 modf pow signgam sin sinh sqrt tanh tgamma y0 y1 yn
"""
CODE = _words(_OWN, _MATH)
"""Names that the emitted files define or use themselves, and functions of <math.h>."""
