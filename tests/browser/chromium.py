"""Built pages in a headless Chromium that reaches nothing but them."""

from __future__ import annotations

import json
import shutil
import subprocess
import threading
from dataclasses import dataclass
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
VISITS = Path(__file__).with_name("visits.js")


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a page shows: what is wrong with it, and how many formulas are set."""

    complaints: list[str]
    formulas: int


class Pages(ThreadingHTTPServer):
    """A server of a folder; it also hands out the script of a visit, and keeps the answers."""

    daemon_threads = True

    def __init__(self, folder: Path, call: dict[str, object]):
        super().__init__(("127.0.0.1", 0), partial(Handler, directory=str(folder)))
        self.call = call
        self.answers: dict[str, Answer] = {}
        self.is_answered = threading.Event()


class Handler(SimpleHTTPRequestHandler):
    """Serves files, `/visits` and `/answers`."""

    server: Pages

    def do_GET(self):
        if self.path != "/visits":
            super().do_GET()
            return
        script = f"{VISITS.read_text()}\nvisit({json.dumps(self.server.call)});"
        page = f"<!doctype html><body><script>{script}</script></body>".encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(page)))
        self.end_headers()
        self.wfile.write(page)

    def do_POST(self):
        told = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.answers = {address: Answer(**answer) for address, answer in told.items()}
        self.send_response(204)
        self.end_headers()
        self.server.is_answered.set()

    def log_message(self, format, *words):
        """Say nothing."""


def words(profile: Path) -> list[str]:
    """Return the command of a browser without a screen, a network or a history."""
    return [
        str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
        "--disable-background-networking", "--disable-component-update", "--disable-sync",
        "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1", f"--user-data-dir={profile}",
    ]  # fmt: skip


def visit(
    folder: Path, addresses: list[str], profile: Path, *, width: int = 1280, columns: int = 100,
    timeout: float = 300,
) -> dict[str, Answer]:  # fmt: skip
    """Open pages of a folder at a width in pixels; code of so many columns must fit."""
    call: dict[str, object] = {"addresses": addresses, "width": width, "columns": columns}
    with Pages(folder, call) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}/visits"
        browser = subprocess.Popen(
            [*words(profile), "--remote-debugging-port=0", "--window-size=1400,1000", address],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            assert server.is_answered.wait(timeout), f"no answer in {timeout} s"
        finally:
            browser.terminate()
            browser.wait(10)
            server.shutdown()
        return server.answers


def shown(path: Path, profile: Path) -> str:
    """Return the page that a browser makes of a file, opened without any server."""
    done = subprocess.run(
        [*words(profile), "--virtual-time-budget=20000", "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    return done.stdout
