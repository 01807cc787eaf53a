"""A proxy between a client and the service that does what networks do: it refuses, hangs up, and cuts answers short."""
import http.client
import threading
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

NOT_PASSED_ON = ("connection", "keep-alive", "transfer-encoding", "content-length")


class Fault:
    """What happens to the requests that match, so many times."""

    def __init__(self, method, path_end, times=1, status=None, headers=None, cut_after=None, drop_answer=False):
        self.method, self.path_end, self.times = method, path_end, times
        self.status, self.headers, self.cut_after, self.drop_answer = status, headers or {}, cut_after, drop_answer

    def takes(self, method, path):
        if self.times > 0 and method == self.method and path.endswith(self.path_end):
            self.times -= 1
            return True
        return False


class BadProxy:
    """`faults` is a list that tests fill; `requests` what came: (method, path, headers)."""

    def __init__(self, target):
        self.target = urllib.parse.urlsplit(target)
        self.faults, self.requests = [], []
        self._lock = threading.Lock()
        proxy = self

        class Handler(BaseHTTPRequestHandler):
            def _handle(self):
                proxy.handle(self)

            do_GET = do_POST = do_DELETE = do_HEAD = _handle

            def log_message(self, *_):
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()

    def sent(self, method, path_end):
        """The headers of the requests that match, in order."""
        with self._lock:
            return [headers for m, path, headers in self.requests if m == method and path.endswith(path_end)]

    def handle(self, handler):
        with self._lock:
            self.requests.append((handler.command, handler.path, dict(handler.headers)))
            fault = next((fault for fault in self.faults if fault.takes(handler.command, handler.path)), None)
        body = handler.rfile.read(int(handler.headers.get("Content-Length", 0))) or None
        if fault and fault.status:
            handler.send_response(fault.status)
            for name, value in fault.headers.items():
                handler.send_header(name, value)
            handler.send_header("Content-Length", "0")
            handler.end_headers()
            return
        service = http.client.HTTPConnection(self.target.hostname, self.target.port, timeout=60)
        try:
            service.request(handler.command, handler.path, body, {**dict(handler.headers), "Host": self.target.netloc})
            answer = service.getresponse()
            if fault and fault.drop_answer:
                answer.read()
                return
            self._pass_on(handler, answer, fault.cut_after if fault else None)
        except OSError:
            pass  # one side is gone
        finally:
            service.close()

    @staticmethod
    def _pass_on(handler, answer, cut_after):
        handler.send_response(answer.status)
        for name, value in answer.getheaders():
            if name.lower() not in NOT_PASSED_ON:
                handler.send_header(name, value)
        if answer.getheader("Content-Length"):
            handler.send_header("Content-Length", answer.getheader("Content-Length"))
        handler.end_headers()
        sent = 0
        while True:
            piece = answer.read1(65536)
            if cut_after is not None and sent + len(piece) > cut_after:
                piece = piece[:cut_after - sent]
                handler.wfile.write(piece)
                return
            if not piece:
                return
            handler.wfile.write(piece)
            sent += len(piece)
