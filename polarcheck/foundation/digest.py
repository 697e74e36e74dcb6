"""Digests without OpenSSL, which hashlib loads: 1 % of a small check, and more of one that is repeated."""

from __future__ import annotations

import sys
from importlib import import_module

try:
    from _blake2 import blake2b as blake2b

    _sha256 = import_module("_sha2" if sys.version_info >= (3, 12) else "_sha256").sha256
except ImportError:  # of a Python that is built without them
    from hashlib import blake2b as blake2b
    from hashlib import sha256 as _sha256

#: OpenSSL is several times as fast: for longer data its import pays [bytes].
_LONG = 200_000


def sha256_of(data: bytes) -> str:
    """Return the SHA-256 of data in hexadecimal."""
    if len(data) < _LONG:
        return str(_sha256(data).hexdigest())
    import hashlib

    return hashlib.sha256(data).hexdigest()
