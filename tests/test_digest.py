"""Digests are those of hashlib, whatever makes them."""

from __future__ import annotations

import hashlib

import pytest

from polarcheck.foundation.digest import blake2b, sha256_of


@pytest.mark.parametrize("size", [0, 23, 199_999, 200_000, 400_000])
def test_a_digest_is_that_of_hashlib(size: int) -> None:
    data = bytes(number % 251 for number in range(size))
    assert sha256_of(data) == hashlib.sha256(data).hexdigest()
    assert blake2b(data, digest_size=16).digest() == hashlib.blake2b(data, digest_size=16).digest()
