"""Holds pages of the console open as a browser does, but shows nothing: python -m tools.bench.distant_browser URL...

It loads each page, keeps its websocket open, acknowledges its messages and asks for the drawings of its view in the
pace that the console wishes.
"""

import ast
import asyncio
import json
import re
import sys
import urllib.request
from contextlib import suppress
from urllib.parse import urlencode, urlsplit

from websockets.asyncio.client import ClientConnection, connect

_QUERY = re.compile(r"query: (\{.*\}),")
_PERIOD_S = 0.05
_ACKNOWLEDGE_S = 3.0


async def _main(urls: list[str]) -> None:
    await asyncio.gather(*(_open(url) for url in urls))


async def _open(url: str) -> None:
    """Keeps a page open until it is cancelled."""
    made = await asyncio.to_thread(_loaded, url)
    found = _QUERY.search(made)
    if not found:
        raise ValueError(f"{url}: not a page of the console: {made[:500]}")
    query = ast.literal_eval(found[1])
    parts = urlsplit(url)
    where = {**query, "document_id": f"document {url}", "tab_id": f"tab {url}", "EIO": "4", "transport": "websocket"}
    address = f"ws://{parts.netloc}/_nicegui_ws/socket.io/?{urlencode(where).replace('True', 'true')}"
    async with connect(address, origin=f"http://{parts.netloc}", max_size=None) as page:  # type: ignore[arg-type]
        tasks = [_listen(page, query["client_id"])]
        if parts.path == "/view":
            tasks.append(_draw(f"/drawing?{parts.query}&view=0", parts.netloc))
        print(f"open {url}", flush=True)
        await asyncio.gather(*tasks)


def _loaded(url: str) -> str:
    with urllib.request.urlopen(url, timeout=60) as answer:
        return str(answer.read().decode())


async def _listen(page: ClientConnection, client_id: str) -> None:
    """Takes and acknowledges the messages of the page."""
    numbers = re.compile(r'"_id":(\d+)')
    acknowledged_s = 0.0
    loop = asyncio.get_running_loop()
    async for data in page:
        text = data if isinstance(data, str) else data.decode()
        if text == "2":
            await page.send("3")
        elif text.startswith("0"):
            await page.send("40")
        elif (ids := numbers.findall(text)) and loop.time() > acknowledged_s + _ACKNOWLEDGE_S:
            acknowledged_s = loop.time()
            told = {"client_id": client_id, "next_message_id": int(ids[-1]) + 1}
            await page.send(f'42["ack",{json.dumps(told)}]')


async def _draw(path: str, host: str) -> None:
    """Asks for one drawing after the other; as in a browser, a closed connection is opened again."""
    name, _, port = host.partition(":")
    have = ""
    while True:
        reader, writer = await asyncio.open_connection(name, int(port))
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                have = await _drawn(reader, writer, path, host, have)
        writer.close()


async def _drawn(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, path: str, host: str, have: str) -> str:
    """Asks for a drawing unless it is `have`, and waits until the next one is due; returns the name of the drawing."""
    loop = asyncio.get_running_loop()
    began_s = loop.time()
    writer.write(f"GET {path}&have={have}&ground={have.partition('.')[2]} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
    head = (await reader.readuntil(b"\r\n\r\n")).decode().lower()
    fields = dict(line.split(": ", 1) for line in head.split("\r\n")[1:] if ": " in line)
    await reader.readexactly(int(fields.get("content-length", 0)))
    if head.split()[1] not in ("200", "204"):
        await asyncio.sleep(1.0)
    else:
        print("drawing", flush=True)
    period_s = max(_PERIOD_S, float(fields.get("fwk-period-ms", 0)) / 1000)
    await asyncio.sleep(max(0.0, began_s + period_s - loop.time()))
    return fields.get("fwk-drawing", "")


if __name__ == "__main__":
    asyncio.run(_main(sys.argv[1:]))
