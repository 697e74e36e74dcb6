"""
The files of a cache: bytes by digest, in a folder `.polarcheck_cache`.

A file is trusted only with a seal that needs a key of the user. The key lies outside of the cache, so a cache that
comes with an archive, or from another user, makes no program pass. Whatever goes wrong here costs time and no more:
what cannot be read is absent, what cannot be written is left out.
"""

import contextlib
import os
import stat
import sys
from pathlib import Path

from polarcheck.foundation import bounded, record
from polarcheck.foundation.digest import blake2b
from polarcheck.foundation.patterns import lazy_pattern

NAME = ".polarcheck_cache"
#: The largest file, of 256; entries that have not been used for the longest time go first [bytes].
LARGEST = 1_000_000
_SEAL, _KEY = 32, 32
_KEY_NAME = "cache-key"
_IS_VERSION = lazy_pattern(r"[0-9a-f]{16}")
#: The largest run that can be repeated, of 256 [bytes].
LARGEST_RUN = 200_000
_IS_SHARD = lazy_pattern(r"(run)?[0-9a-f]{2}\.cache|\.[0-9a-f]{16}\.new")
_TAG = (
    "Signature: 8a477f597d28d172789f06886806bc55\n"
    "# This folder is a cache of polarcheck, and can be deleted. For information about cache directory tags see:\n"
    "#\thttps://bford.info/cachedir/\n"
)

Entries = dict[bytes, bytes]


class Store:
    """
    Bytes by digests of 16 bytes, for one version of the code.

    Several processes may use the same folder: each file is replaced as a whole.
    """

    def __init__(self, folder: str, version: bytes, key: bytes, *, links: bool = False) -> None:
        """folder: of the cache, which need not exist. links: it may be a link, since the user has named it."""
        self._root = folder
        self._links = links
        self._folder = os.path.join(folder, version.hex())  # noqa: PTH118
        self._version = version
        self._key = key
        self._shards: dict[str, Entries] = {}
        self._used: dict[str, dict[bytes, None]] = {}
        self._new: dict[str, Entries] = {}
        self._is_ready: bool | None = None

    def get(self, digest: bytes) -> bytes | None:
        """Return the bytes of a digest; None if there are none."""
        shard = _shard(digest)
        if shard not in self._shards:
            self._shards[shard] = self._read(shard)
        return self._shards[shard].get(digest)

    def use(self, digest: bytes) -> None:
        """Note that an entry was used: others are dropped before it."""
        self._used.setdefault(_shard(digest), {})[digest] = None

    def put(self, digest: bytes, data: bytes) -> None:
        """Add an entry; it is written by `write`."""
        if len(data) < LARGEST // 2:
            self._new.setdefault(_shard(digest), {})[digest] = data

    @property
    def waiting(self) -> int:
        """Return the number of files that `write` would replace."""
        return len(self._new)

    def write(self) -> None:
        """Write the new entries beside those that other processes have written meanwhile; mend the folder."""
        import msgspec  # a run that is repeated does without

        new, self._new = self._new, {}
        with contextlib.suppress(OSError):
            if not new and os.path.isdir(self._root):  # noqa: PTH112
                self._prepared()
            for shard, entries in new.items():
                if not self._prepared():
                    return
                merged = self._merged(shard, entries)
                self._shards[shard] = merged
                self._write_sealed(shard, msgspec.msgpack.encode(merged))

    def run(self, digest: bytes) -> bytes | None:
        """Return the bytes of a whole run; None if there are none."""
        with contextlib.suppress(OSError, ValueError):
            data = self._sealed(f"run{_shard(digest)}", LARGEST_RUN + len(digest))
            if data.startswith(digest):
                return data[len(digest) :]
        return None

    def put_run(self, digest: bytes, data: bytes) -> None:
        """Write the bytes of a whole run, in the place of another one whose digest begins with the same byte."""
        if len(data) < LARGEST_RUN:
            with contextlib.suppress(OSError):
                self._write_sealed(f"run{_shard(digest)}", digest + data)

    def _merged(self, shard: str, new: Entries) -> Entries:
        """Return the entries of a file: the new ones, those that this run has used, then the others while they fit."""
        present = self._read(shard)
        used = {digest: present[digest] for digest in self._used.get(shard, ()) if digest in present}
        needed = used | new
        unused = {digest: data for digest, data in reversed(present.items()) if digest not in needed}
        merged: Entries = {}
        size = 0
        for digest, data in (needed | unused).items():
            size += len(data) + len(digest) + 8
            if size > LARGEST:
                break
            merged[digest] = data
        return dict(reversed(merged.items()))

    def _read(self, shard: str) -> Entries:
        from polarcheck.foundation.decoding import msgpack_decoder

        try:
            return msgpack_decoder(Entries).decode(self._sealed(shard, 2 * LARGEST))
        except (OSError, ValueError):  # a ValueError is that of msgspec, too
            return {}

    def _sealed(self, name: str, limit: int) -> bytes:
        """Return the content of a file; raises OSError or ValueError if there is none, or its seal is broken."""
        if not self.is_own_folder():
            raise ValueError("another folder")
        data = _read_file(self._path(name), _SEAL + limit)
        if data[:_SEAL] != self._seal(name, data[_SEAL:]):
            raise ValueError("another seal")
        return data[_SEAL:]

    def _write_sealed(self, name: str, data: bytes) -> None:
        _replace(self._path(name), self._seal(name, data) + data)

    def is_own_folder(self) -> bool:
        """Return False if the folder, or that of the version in it, is a link: it may lead anywhere."""
        return (self._links or _is_folder(self._root)) and _is_folder(self._folder)

    def _path(self, name: str) -> str:
        return os.path.join(self._folder, f"{name}.cache")  # noqa: PTH118

    def _seal(self, name: str, data: bytes) -> bytes:
        return blake2b(data, digest_size=_SEAL, key=self._key, person=self._version + name.encode()).digest()

    def _prepared(self) -> bool:
        """Make the folders; return False if they cannot be used."""
        if self._is_ready is None:
            self._is_ready = self._prepare()
        return self._is_ready

    def _prepare(self) -> bool:
        with contextlib.suppress(FileExistsError):
            os.mkdir(self._root)  # noqa: PTH102
        if not self._links and not _is_folder(self._root):
            return False
        for name, text in ((".gitignore", "*\n"), ("CACHEDIR.TAG", _TAG)):
            path = os.path.join(self._root, name)  # noqa: PTH118
            if not self._is_sound(path, text.encode()):
                _replace(path, text.encode())
        try:
            os.mkdir(self._folder)  # noqa: PTH102
        except FileExistsError:
            return self.is_own_folder()
        self._remove_other_versions()
        return True

    def _is_sound(self, path: str, data: bytes) -> bool:
        """Return True for a file that holds what it should: a full disk may have left it empty."""
        if not self._links:
            return _content(path) == data
        # A folder that the user has named may have a file of its own, which stays.
        try:
            status = os.lstat(path)
        except OSError:
            return False
        return status.st_size > 0 or not stat.S_ISREG(status.st_mode)

    def _remove_other_versions(self) -> None:
        with contextlib.suppress(OSError), os.scandir(self._root) as entries:
            for entry in entries:
                is_other = _IS_VERSION.fullmatch(entry.name) and entry.name != self._version.hex()
                if is_other and entry.is_dir(follow_symlinks=False):
                    _remove_version(entry.path)


def _shard(digest: bytes) -> str:
    return digest[:1].hex()


def _read_file(path: str, limit: int) -> bytes:
    """Return the content of a file of the cache, on which no report depends. Raises OSError."""
    with record.unrecorded():
        return bounded.read_file(path, limit, "")


def _is_folder(path: str) -> bool:
    try:
        return stat.S_ISDIR(os.lstat(path).st_mode)
    except OSError:
        return False


def _create(path: str, data: bytes, mode: int = 0o666) -> None:
    """Write a new file; raises FileExistsError for a file or link that is there."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags, mode), "wb") as file:
        file.write(data)


def _replace(path: str, data: bytes) -> None:
    """Write a file whole or not at all, in the place of one that is there."""
    temporary = os.path.join(os.path.dirname(path), f".{os.urandom(8).hex()}.new")  # noqa: PTH118, PTH120
    try:
        _create(temporary, data)
        os.replace(temporary, path)  # noqa: PTH105
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(temporary)  # noqa: PTH108
        raise


def _content(path: str) -> bytes:
    """Return the content of a small file; empty for a link and for what cannot be read."""
    with contextlib.suppress(OSError):
        if not os.path.islink(path):  # noqa: PTH114
            return _read_file(path, len(_TAG))
    return b""


def _remove_version(folder: str) -> None:
    """Remove the files of a cache from a folder, and the folder if nothing else is in it."""
    with contextlib.suppress(OSError):
        for name in os.listdir(folder):  # noqa: PTH208
            if _IS_SHARD.fullmatch(name):
                os.unlink(os.path.join(folder, name))  # noqa: PTH108, PTH118
        os.rmdir(folder)  # noqa: PTH106


# ---- the key ----


def user_key() -> bytes | None:
    """Return the key of the user, which is made at the first call; None if there is no place for it."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA", "")
    else:
        base = os.environ.get("XDG_CACHE_HOME", "")
        if not os.path.isabs(base):  # noqa: PTH117
            within = ("Library", "Caches") if sys.platform == "darwin" else (".cache",)
            base = os.path.join(os.path.expanduser("~"), *within)  # noqa: PTH111, PTH118
    return folder_key(os.path.join(base, "polarcheck")) if os.path.isabs(base) else None  # noqa: PTH117, PTH118


def folder_key(folder: str) -> bytes | None:
    """Return the key in a folder; both are made if there is none. None if that is impossible."""
    path = os.path.join(folder, _KEY_NAME)  # noqa: PTH118
    temporary = f"{path}.{os.urandom(8).hex()}"
    try:
        key = _read_key(path)
        if not key:
            Path(folder).mkdir(mode=0o700, parents=True, exist_ok=True)
            _create(temporary, os.urandom(_KEY), 0o600)
            os.replace(temporary, path)  # noqa: PTH105
            key = _read_key(path)  # that of another process which has done so at the same time
    except OSError:
        return None
    return key or None


def _read_key(path: str) -> bytes:
    """Return the key in a file; empty if there is none. Raises OSError for what is no file."""
    if not os.path.lexists(path):
        return b""
    key = _read_file(path, _KEY)
    return key if len(key) == _KEY else b""
