#!/bin/bash
# PyPI asyncua 2.1.0, OPC UA server: a dead band compares a value with the one before it, not with the last one sent: a load that rises by 6 at a time is never sent again under a dead band of 10; a dead band in percent is accepted, and all values are sent.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check asyncua==2.1.0 2> /dev/null
cat > run.py <<'END'
import asyncio
import logging
import socket

from asyncua import Client, Server, ua

logging.disable(logging.CRITICAL)
ABSOLUTE, PERCENT = 1, 2


class Values(list):
    def datachange_notification(self, node, value, data):
        self.append(value)


async def sent(client, load, deadband, kind, written):
    """The values that a subscription with this dead band gets of those written."""
    values = Values()
    await load.write_value(written[0])
    subscription = await client.create_subscription(20, values)
    await subscription.deadband_monitor(client.get_node(load.nodeid), deadband, deadbandtype=kind)
    for value in written[1:]:
        await load.write_value(value)
        await asyncio.sleep(0.2)
    await subscription.delete()
    return values


async def main():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"opc.tcp://127.0.0.1:{free.getsockname()[1]}/"
    server = Server()
    await server.init()
    server.set_endpoint(address)
    load = await server.nodes.objects.add_variable(await server.register_namespace("machine"), "load", 0.0)
    await load.add_property(0, "EURange", ua.Range(0.0, 1000.0))
    print("asyncua 2.1.0: dead band, values written, values sent")
    async with server, Client(address) as client:
        for name, deadband, kind, written, seen in (
            ("10", 10, ABSOLUTE, [0.0, 25.0, 26.0], [0, 25]),
            ("10", 10, ABSOLUTE, [0.0, 6.0, 12.0, 18.0, 24.0, 30.0], [0]),
            ("10 % of 1000", 10, PERCENT, [0.0, 50.0, 99.0, 150.0], [0, 50, 99, 150]),
        ):
            values = await sent(client, load, deadband, kind, written)
            print(f"{name}: {written} {values}")
            assert values == seen, "changed"


asyncio.run(main())
END
python/bin/python -W ignore run.py
