"""`plot --serve`: what is served to whom, what makes the pages anew, and a browser that shows them."""

from __future__ import annotations

import contextlib
import http.client
import json
import random
import re
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from test_cli import call, make, process
from test_drawing_options import dxf
from test_page_in_browser import CHROMIUM, browser, frames, until
from test_pictures import GROOVE, HEXAGON
from test_plot import PLOTLY, RADIUS

from polarcheck.commands import serving, watching
from polarcheck.view import page_server, plotly_script
from polarcheck.view import page_server as served

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]
__all__ = ["browser"]  # a fixture


class Visitor:
    """A browser that asks for pages, and hears of new versions."""

    def __init__(self) -> None:
        self.address = ""

    def ask(self, path: str = "", host: str = "", method: str = "GET", below_token: bool = True) -> tuple[int, str]:
        """Status and content; the path is below the token."""
        with self.answer(path, host, method, below_token) as answer:
            return answer.status, answer.read().decode()

    def answer(self, path: str, host: str = "", method: str = "GET", below_token: bool = True) -> Any:
        parts = urlsplit(self.address)
        connection = http.client.HTTPConnection(parts.netloc, timeout=120)
        headers = {"Host": host} if host else {}
        connection.request(method, (parts.path if below_token else "/") + path, headers=headers)
        return connection.getresponse()

    def event(self, name: str = "") -> dict[str, str]:
        """Version and notice of a page."""
        with self.answer(f"events/{name}") as answer:
            event: dict[str, str] = json.loads(answer.readline().removeprefix(b"data: "))
        return event


@pytest.fixture
def visitor(monkeypatch: pytest.MonkeyPatch) -> Visitor:
    """Hears the address; plotly is short."""
    visitor = Visitor()

    def show(text: str) -> bool:
        visitor.address = text.strip()
        return True

    monkeypatch.setattr(serving, "show", show)
    monkeypatch.setattr(plotly_script, "library", lambda: PLOTLY)
    return visitor


@pytest.fixture
def between(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Sets what is done between the runs: each returns the changed files; behind the last one is Ctrl-C."""

    def set_steps(*steps: Callable[[], object]) -> None:
        rest = iter(steps)

        def next_change(seen: watching.Seen) -> list[str]:
            step = next(rest, None)
            if step is None:
                raise KeyboardInterrupt
            step()
            assert seen.changed() or step.__name__.startswith("look")
            return ["a.nc"]

        monkeypatch.setattr(watching, "_next_change", next_change)

    return set_steps


@pytest.mark.nightly
def test_a_saved_program_is_a_new_version_and_a_broken_one_keeps_the_last(
    visitor: Visitor, between: Callable[..., None]
) -> None:
    make(a__nc=GROOVE)
    versions: list[str] = []

    def first() -> None:
        status, page = visitor.ask()
        assert status == 200
        assert "1 error" in page
        assert "connect-src 'self'" in page
        versions.append(visitor.event()["version"])
        assert f'content="{versions[0]}"' in page
        assert visitor.ask("plotly.min.js") == (200, PLOTLY)
        make(a__nc=HEXAGON)

    def second() -> None:
        assert "no findings" in visitor.ask()[1]
        versions.append(visitor.event()["version"])
        make(a__nc="")

    def empty() -> None:
        assert "no findings" in visitor.ask()[1]
        assert visitor.event() == {
            "version": versions[1],
            "notice": "a.nc: the program is empty. This is the last state that could be read.",
        }
        Path("a.nc").unlink()

    def deleted() -> None:
        assert "No such file" in visitor.event()["notice"]
        assert visitor.event()["version"] == versions[1]
        make(a__nc=HEXAGON)

    def the_same_again() -> None:
        assert visitor.event() == {"version": versions[1], "notice": ""}
        make(polarcheck__toml="machine = 7\n")

    def broken_job() -> None:
        assert "polarcheck.toml" in visitor.event()["notice"]
        make(polarcheck__toml='machine = "fanuc-30i"\n')

    def other_machine() -> None:
        assert visitor.event()["notice"] == ""
        assert "(fanuc-30i)" in visitor.ask()[1]
        Path("polarcheck.toml").unlink()

    between(first, second, empty, deleted, the_same_again, broken_job, other_machine)
    result = call("plot", "--serve", "a.nc", *RADIUS)
    assert result.exit_code == 0, result.output
    assert versions[0] != versions[1]
    assert "watching for changes; Ctrl-C ends" in result.stderr
    with pytest.raises(OSError, match=r"refused|Connection"):
        visitor.ask()


@pytest.mark.nightly
def test_a_folder_has_an_index_and_new_programs_come_to_it(visitor: Visitor, between: Callable[..., None]) -> None:
    Path("f").mkdir()
    make(**{"f/a__nc": HEXAGON, "f/b__nc": GROOVE})
    versions: list[str] = []

    def first() -> None:
        assert re.findall('href="([^"]*)"', visitor.ask()[1]) == ["a.nc.html", "b.nc.html"]
        assert "1 error" in visitor.ask("b.nc.html")[1]
        assert "default-src 'none'" in visitor.ask()[1]
        versions.extend(visitor.event(name)["version"] for name in ("", "a.nc.html", "b.nc.html"))
        Path("f/A").mkdir()
        make(**{"f/A/b__nc": HEXAGON})

    def another() -> None:
        # Names stay as they are, whatever comes before them.
        assert re.findall('href="([^"]*)"', visitor.ask()[1]) == ["b.nc-2.html", "a.nc.html", "b.nc.html"]
        assert [visitor.event(name)["version"] for name in ("a.nc.html", "b.nc.html")] == versions[1:]
        assert visitor.event()["version"] != versions[0]
        Path("f/a.nc").unlink()

    def deleted() -> None:
        assert visitor.event("a.nc.html")["notice"].startswith("f/a.nc: the program is not there.")
        assert visitor.event("b.nc.html")["notice"] == ""
        Path("f/new.nc").write_bytes(b"")

    between(first, another, deleted)
    assert call("plot", "--serve", "f", *RADIUS, "-j", "1").exit_code == 0


@pytest.mark.nightly
def test_a_page_depends_on_drawing_offsets_and_subprograms(visitor: Visitor, between: Callable[..., None]) -> None:
    Path("subs").mkdir()
    make(a__nc=HEXAGON.replace("G40 X80.", "M98 P100\nG40 X80."), **{"subs/O0100__nc": "O0100\nM99\n"})
    make(offsets__txt="%\nG10 P8 X0 Z0 R4. Q0\n%\n")
    dxf(Path("part.dxf"), {"0": [15, 15j, -15]})
    versions: list[str] = []

    def change_drawing() -> None:
        versions.append(visitor.event()["version"])
        dxf(Path("part.dxf"), {"0": [15, 15j, -15, -15j]})

    def change_offsets() -> None:
        versions.append(visitor.event()["version"])
        make(offsets__txt="%\nG10 P8 X0 Z0 R5. Q0\n%\n")

    def change_subprogram() -> None:
        versions.append(visitor.event()["version"])
        make(**{"subs/O0100__nc": "O0100\nG1 C2.\nM99\n"})

    def look() -> None:
        versions.append(visitor.event()["version"])

    between(change_drawing, change_offsets, change_subprogram, look)
    words = ("--offsets", "offsets.txt", "--drawing", "part.dxf", "--subprograms", "subs")
    assert call("plot", "--serve", "a.nc", *words).exit_code == 0
    assert len({*versions}) == 4


def test_nobody_else_gets_anything(visitor: Visitor, between: Callable[..., None]) -> None:
    make(a__nc=HEXAGON, b__nc=HEXAGON)

    def look() -> None:
        for host in ("evil.example", "evil.example:80", "127.0.0.1.evil.example", "[::1]:80", "a@localhost:1:2"):
            assert visitor.ask(host=host)[0] == 421
        for host in ("localhost", "localhost:8000", "127.0.0.1:1"):
            assert visitor.ask(host=host)[0] == 200
        for path in ("", "a.nc", "plotly.min.js", "x" * 22 + "/"):
            assert visitor.ask(path, below_token=False)[0] == 404
        for path in ("a.nc", "b.nc", "../a.nc", "%2e%2e/a.nc", "first.html", "events/a.nc", "<script>", "events/../"):
            status, answer = visitor.ask(path)
            assert status == 404
            assert "script" not in answer
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "CONNECT"):
            assert visitor.ask(method=method)[0] == 501
        assert visitor.ask(method="HEAD") == (200, "")
        assert visitor.ask("events/", method="HEAD") == (200, "")
        answer = visitor.answer("")
        assert answer.getheader("Access-Control-Allow-Origin") is None
        assert answer.getheader("Cross-Origin-Resource-Policy") == "same-origin"
        answer.close()

    between(look)
    assert call("plot", "--serve", "a.nc", *RADIUS).exit_code == 0


# ---- whatever is sent ----


class Attacker:
    """Sends bytes to a server with one page; `errors` has what the server said of itself."""

    def __init__(self) -> None:
        self.errors: list[Exception] = []
        self.open: list[socket.socket] = []
        site = served.Site()
        site.put("", served.Served(lambda: b"the page", "text/html", "1"))
        self.server = served.Server(site, 0, self.errors.append)
        self.visitor = Visitor()
        self.visitor.address = self.server.address
        parts = urlsplit(self.server.address)
        self.where, self.path = ("127.0.0.1", parts.port or 0), parts.path.encode()

    def connect(self, data: bytes = b"") -> socket.socket:
        """A connection that stays open behind some bytes."""
        connection = socket.create_connection(self.where, 30)
        self.open.append(connection)
        with contextlib.suppress(OSError):
            connection.sendall(data)
        return connection

    def answer(self, data: bytes) -> bytes:
        """All that the server sends back, until it closes the connection."""
        connection = self.connect(data)
        with contextlib.suppress(OSError):
            connection.shutdown(socket.SHUT_WR)
        return until_closed(connection)


def until_closed(connection: socket.socket) -> bytes:
    """All that is sent until a connection is closed, by a reset too, as with bytes that nobody has read."""
    answer = b""
    with contextlib.suppress(ConnectionError):
        while data := connection.recv(65536):
            answer += data
    connection.close()
    return answer


@pytest.fixture
def attacker() -> Iterator[Attacker]:
    attacker = Attacker()
    with attacker.server:
        attacker.server.start()
        yield attacker
        for connection in attacker.open:
            connection.close()
        assert attacker.visitor.ask() == (200, "the page")
    assert attacker.errors == []


RIGHT = b"Host: 127.0.0.1\r\n"


@pytest.mark.parametrize(
    ("request_", "status"),
    [
        (b"GET http://[ HTTP/1.1\r\n" + RIGHT, 400),
        (b"GET http://[TOKEN HTTP/1.1\r\n" + RIGHT, 400),
        (b"HEAD http://]/ HTTP/1.0\r\n" + RIGHT, 400),
        (b"GET http://[v1.x]/ HTTP/1.1\r\n" + RIGHT, 421),
        (b"GET http://[::1]TOKEN HTTP/1.1\r\n" + RIGHT, 421),
        (b"GET http://evil.exampleTOKEN HTTP/1.1\r\n" + RIGHT, 421),
        (b"GET http://127.0.0.1:80TOKEN HTTP/1.1\r\nHost: evil.example\r\n", 200),
        (b"GET TOKEN?x=[#y HTTP/1.1\r\n" + RIGHT, 200),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"Content-Length: -1e99\r\nTransfer-Encoding: \xff\r\n", 200),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"Expect: 100-continue\r\nConnection: keep-alive\r\n", 200),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"Content-Type: multipart/x; boundary=y\r\n", 200),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"Content-Type: multipart/x; boundary*=%00''x\r\n", 400),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"Content-Type: multipart/x; boundary*=idna''%ff\r\n", 400),
        (b"GET / HTTP/1.1\r\n" + RIGHT + b"Content-Type: message/x; a*" + b"9" * 5000 + b"=1\r\n", 404),
        (b"GET / HTTP/1.1\r\n" + RIGHT + b"Content-Type: multipart/x; a*" + b"9" * 5000 + b"=1\r\n", 400),
        (b"GET TOKEN HTTP/1.1\r\nHost: \xff[\0]:\r\n", 421),
        (b"GET TOKEN HTTP/1.1\r\n", 421),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"X: " + b"a" * 70000 + b"\r\n", 431),
        (b"GET TOKEN HTTP/1.1\r\n" + RIGHT + b"X: a\r\n" * 200, 431),
        (b"GET /%00%ff%2e%2e%zz TOKEN HTTP/1.1\r\n" + RIGHT, 400),
        (b"GET /%00%ff%zz HTTP/1.1\r\n" + RIGHT, 404),
        (b"GET TOKEN%00 HTTP/1.1\r\n" + RIGHT, 404),
        (b"GET TOKEN HTTP/1.\xb2\r\n" + RIGHT, 400),
        (b"GET TOKEN HTTP/9999999999999.1\r\n" + RIGHT, 400),
        (b"GET TOKEN HTTP/2.0\r\n" + RIGHT, 505),
        (b"PRI * HTTP/2.0\r\n\r\nSM\r\n", 505),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n", 400),
        (b"\0 \0 \0\r\n", 400),
        (b"__class__ TOKEN HTTP/1.1\r\n" + RIGHT, 501),
        (b"get TOKEN HTTP/1.1\r\n" + RIGHT, 501),
        (b"GET /" + b"a" * 70000, 414),
    ],
    ids=lambda data: repr(data)[:50] if isinstance(data, bytes) else str(data),
)
def test_an_odd_request_is_refused_and_nothing_is_said_of_it(attacker: Attacker, request_: bytes, status: int) -> None:
    answer = attacker.answer(request_.replace(b"TOKEN", attacker.path) + b"\r\n")
    if len(request_) > 60000 and not answer:
        return  # the answer is lost where the connection is closed before all is read
    # Without a version that can be read the answer has no head.
    said = re.match(rb"HTTP/1\.0 (\d+) |<!DOCTYPE[^$]*<p>Error code: (\d+)<", answer)
    assert said is not None
    assert int(said[1] or said[2]) == status
    assert (b"the page" in answer) is (status == 200)


def test_a_request_without_a_version_or_without_words_is_no_page(attacker: Attacker) -> None:
    for data in (b"", b"\r\n", b"\n\n\n", b"GET\r\n\r\n", b"GET " + attacker.path + b"\r\n\r\n", b"\xff" * 100):
        assert b"the page" not in attacker.answer(data)


def test_of_requests_one_behind_the_other_the_first_is_answered(attacker: Attacker) -> None:
    request = b"GET " + attacker.path + b" HTTP/1.1\r\n" + RIGHT + b"Connection: keep-alive\r\n\r\n"
    assert attacker.answer(request * 5).count(b"the page") <= 1


#: Pieces of requests; TOKEN is the path of the page.
PIECES = (
    *(
        b"GET",
        b"HEAD",
        b"POST",
        b" ",
        b" ",
        b"TOKEN",
        b"/",
        b"http://",
        b"[",
        b"]",
        b"@",
        b":",
        b"?",
        b"#",
        b"%",
        b"%00",
    ),
    *(
        b" HTTP/1.1\r\n",
        b" HTTP/1.0\r\n",
        b"HTTP/",
        b"2.0",
        b"\r\n",
        b"\r\n",
        b"\n",
        b"\r",
        b"\0",
        b"\t",
        b"\x85",
        b"\xff",
    ),
    *(
        b"Host: ",
        b"127.0.0.1",
        b"localhost",
        RIGHT,
        b"Content-Type: ",
        b"multipart/x",
        b"; boundary",
        b"*=",
        b"''",
        b'"',
    ),
    *(
        b"idna",
        b"utf-16",
        b"*0*",
        b"Content-Length: ",
        b"-1",
        b"9" * 30,
        b"Connection: keep-alive\r\n",
        b"\xc2\xb2",
        b"a" * 99,
    ),
)


def drawn_request(seed: int) -> bytes:
    """Bytes that begin as a request, or not."""
    draw = random.Random(seed)  # noqa: S311
    begin = draw.choice([b"GET ", b"GET TOKEN HTTP/1.1\r\n", b"GET TOKEN HTTP/1.1\r\n" + RIGHT, b"HEAD http://", b""])
    rest = b"".join(draw.choices(PIECES, k=draw.randrange(12)))
    return begin + rest + draw.choice([b"", b" HTTP/1.1\r\n" + RIGHT, b"\r\n\r\n"])


@pytest.mark.nightly
@pytest.mark.parametrize("count", [150, pytest.param(4000, marks=pytest.mark.ci)])
def test_drawn_bytes_end_nothing_and_print_nothing(
    attacker: Attacker, count: int, capfd: pytest.CaptureFixture[str]
) -> None:
    for seed in range(count):
        answer = attacker.answer(drawn_request(seed).replace(b"TOKEN", attacker.path))
        assert not answer or answer.startswith((b"HTTP/1.0 ", b"<!DOCTYPE")), seed
        assert attacker.errors == [], seed
    assert capfd.readouterr() == ("", "")


# ---- who holds connections ----


SLOW = (b"", b"G", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ")


@pytest.mark.parametrize("most", [6, pytest.param(page_server.MOST, marks=pytest.mark.ci)])
def test_slow_connections_without_the_token_keep_no_page_away(
    attacker: Attacker, monkeypatch: pytest.MonkeyPatch, most: int
) -> None:
    monkeypatch.setattr(page_server, "MOST", most)
    with attacker.visitor.answer("events/") as event:
        assert event.readline() == b'data: {"version": "1", "notice": ""}\n'
        for _ in range(3):
            for number in range(most):
                attacker.connect(SLOW[number % len(SLOW)])
            assert attacker.visitor.ask() == (200, "the page")
        # The oldest have made room, and the last ones are still there.
        for connection in attacker.open[:most]:
            assert until_closed(connection) == b""
        attacker.open[-1].settimeout(0)
        with pytest.raises(BlockingIOError):
            attacker.open[-1].recv(1)
        # One that has shown the token makes room for none.
        attacker.server._site.notice("", "late")
        event.readline()
        assert event.readline() == b'data: {"version": "1", "notice": "late"}\n'


def test_headers_that_never_end_are_not_waited_for(attacker: Attacker, monkeypatch: pytest.MonkeyPatch) -> None:
    with attacker.visitor.answer("events/") as event:
        event.readline()
        slow = attacker.connect(b"GET " + attacker.path + b" HTTP/1.1\r\n" + RIGHT)
        slow.settimeout(0)
        with pytest.raises(BlockingIOError):
            slow.recv(1)
        slow.settimeout(30)
        monkeypatch.setattr(page_server, "LONGEST", 0.0)
        gone = threading.Event()

        def drip() -> None:
            with contextlib.suppress(OSError):
                while not gone.wait(0.01):
                    slow.sendall(b"X: y\r\n"[:1])

        dripping = threading.Thread(target=drip)
        dripping.start()
        assert until_closed(slow) == b""
        gone.set()
        dripping.join()
        monkeypatch.setattr(page_server, "LONGEST", 60.0)
        # A connection that has shown the token lasts.
        attacker.server._site.notice("", "late")
        event.readline()
        assert event.readline() == b'data: {"version": "1", "notice": "late"}\n'


def test_connections_with_the_token_are_counted_too(attacker: Attacker, monkeypatch: pytest.MonkeyPatch) -> None:
    # The end of the test asks once more, when these connections may still be counted.
    with monkeypatch.context() as few:
        few.setattr(page_server, "MOST", 2)
        events = [attacker.visitor.answer("events/") for _ in range(2)]
        for event in events:
            event.readline()
        assert attacker.visitor.ask()[0] == 503
        few.setattr(page_server, "MOST", 3)
        assert attacker.visitor.ask() == (200, "the page")
    for event in events:
        event.close()


def test_a_bug_in_an_answer_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    said: list[str] = []
    site = served.Site()

    def fail() -> bytes:
        raise RuntimeError("no bytes")

    site.put("", served.Served(fail, "text/html", "1"))
    with served.Server(site, 0, lambda error: said.append(str(error))) as server:
        server.start()
        visitor = Visitor()
        visitor.address = server.address
        with pytest.raises(http.client.RemoteDisconnected):
            visitor.ask()
    assert said == ["no bytes"]


def test_events_tell_of_changes_and_end_with_the_site(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(served, "_BEAT", 0.01)
    site = served.Site()
    site.notice("x", "is not there")
    assert site.get("x") is None
    site.put("x", served.Served(bytes, "", "1"))
    events = site.events("x")
    assert next(events) == ("1", "")
    assert next(events) is None
    site.notice("x", "gone")
    assert next(events) == ("1", "gone")
    site.put("x", served.Served(bytes, "", "2"))
    assert next(events) == ("2", "")
    monkeypatch.setattr(served, "_BEAT", 60.0)
    threading.Timer(0.05, site.close).start()
    assert list(events) == []


def test_the_browser_is_opened_where_that_is_asked_for(
    visitor: Visitor, between: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    make(a__nc=HEXAGON)
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    between()
    assert call("plot", "--serve", "--open", "a.nc", *RADIUS).exit_code == 0
    assert opened == [visitor.address]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--serve", "-"), "--serve: standard input comes once; name a file or folder"),
        (("--serve", "a.nc", "-o", "x.html"), "--serve: not with -o, which is for one look"),
        (("--serve", "a.nc", "--png", "x.png"), "--serve: not with --png, which is for one look"),
        (("a.nc", "--port", "0"), "--port: only with --serve"),
        (("a.nc", "--open"), "--open: only with --serve"),
        (("--serve", "gone.nc"), "gone.nc: No such file or directory"),
        (("--serve", "gone", "--extensions", ".x"), "gone: No such file or directory"),
    ],
)
def test_options_that_do_not_fit_are_one_line(words: tuple[str, ...], said: str, visitor: Visitor) -> None:
    make(a__nc=HEXAGON)
    result = call("plot", *words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"polarcheck: {said}\n"


def test_a_port_in_the_environment_stops_no_other_plot() -> None:
    make(a__nc="G0 X10.\nM30\n")
    assert call("plot", "a.nc", "-o", "a.html", POLARCHECK_PORT="8000", POLARCHECK_OPEN="1").exit_code == 0


def test_an_empty_folder_is_nothing_to_serve() -> None:
    Path("f").mkdir()
    result = call("plot", "--serve", "f")
    assert result.exit_code == 2
    assert result.stderr.count("\n") <= 2


def test_a_port_that_is_taken_is_one_line(visitor: Visitor) -> None:
    make(a__nc=HEXAGON)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = call("plot", "--serve", "a.nc", "--port", str(port))
    assert result.exit_code == 2
    assert result.stderr == f"polarcheck: --port {port}: Address already in use\n"


@pytest.mark.xdist_group("browser")
@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here")
def test_a_browser_shows_what_is_saved_and_keeps_what_is_chosen(browser: Any) -> None:
    make(a__nc=GROOVE)
    running = process("plot", "--serve", "a.nc", *RADIUS, stderr=None)
    try:
        assert running.stdout is not None
        address = running.stdout.readline().strip()
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(f"{address}#L8")
        page.locator(".face .main-svg").first.wait_for()
        face = "document.querySelector('.face')"
        frames(page)  # the face gets its height a moment after it is drawn
        page.evaluate(f"Plotly.Plots.resize({face})")
        page.evaluate(f"Plotly.relayout({face}, {{'xaxis.range': [0, 40], 'yaxis.range': [-10, 10]}})")
        window = page.evaluate(f"{face}._fullLayout.xaxis.range")

        make(a__nc=GROOVE.replace("G12.1", "(NEW)\n(LINES)\nG12.1"))
        page.locator(".polar h2:has-text('lines 5 to 17')").wait_for(timeout=120_000)
        page.locator(".face .main-svg").first.wait_for()
        until(page, lambda: page.evaluate("location.hash") == "#L10")  # `page.url` sometimes misses a changed address
        until(page, lambda: page.evaluate(f"{face}._fullLayout.xaxis.range") == pytest.approx(window))

        Path("a.nc").unlink()
        notice = page.get_by_text("a.nc: No such file or directory. This is the last state")
        notice.wait_for(timeout=120_000)
        make(a__nc=HEXAGON)
        # Not "no findings", which is also said of a file that is read while it is being written, and still empty.
        page.locator(".polar h2:has-text('lines 3 to 14')").wait_for(timeout=120_000)
        assert notice.is_hidden()
        page.get_by_text("no findings").first.wait_for()

        running.send_signal(signal.SIGINT)
        assert running.wait(120) == 0
        page.get_by_text("polarcheck does not serve this page any more").wait_for(timeout=120_000)
        assert errors == []
        page.close()
    finally:
        running.kill()
        running.communicate()
