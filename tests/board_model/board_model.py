"""spidar_board_model for the tests that are written in Python: started, told what its hand does, and asked for the truth."""

import json
import socket
import subprocess
import threading
import time

ANSWER_LIMIT_S = 2.0


class Speaker:
    """A process, and the lines that it has said so far."""

    def __init__(self, command, **options):
        self.lines = []
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def says(self, start, limit_s):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if any(line.startswith(start) for line in list(self.lines)):
                return True
            if self.process.poll() is not None:
                time.sleep(0.1)
                return any(line.startswith(start) for line in self.lines)
            time.sleep(0.01)
        return False

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()


class BoardModel(Speaker):
    """Boards at `link`; the words are options of the program. Use it in a with statement, or call end()."""

    def __init__(self, program, link, *words):
        super().__init__([program, link, *words], stdin=subprocess.PIPE)
        if not self.says("ready", 5):
            self.end()
            raise RuntimeError(f"{program} did not start: {self.lines}")
        self.port = int(self.lines[0].split()[1])
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(ANSWER_LIMIT_S)
        self.socket.connect(("127.0.0.1", self.port))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def tell(self, order="look"):
        """Orders as in orders_talk.h; what is true now."""
        self.socket.send(order.encode())
        return json.loads(self.socket.recv(8192))

    def end(self):
        if self.process.poll() is None:
            self.process.stdin.close()
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                super().end()
