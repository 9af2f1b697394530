#!/usr/bin/env python3
"""A bus whose every port is sent garbage lives, keeps its memory and goes on exchanging messages.

Garbage is: random bytes, RTPS headers with random submessages, and packets that another bus on the domain really sent, replayed,
changed, cut short, put together and made too long. They are sent to every UDP port the process has open, as fast as it takes them.

usage: tests/bus_garbage_test.py BUS_PEER RECORD_PACKETS [--count 20000] [--seed 1] [--keep FILE]
       BUS_PEER, RECORD_PACKETS: the program and the library of these names; --keep: the last packets, when the process dies
"""
import argparse
import collections
import os
import pathlib
import random
import socket
import struct
import sys
import tempfile
import time

from bus_peer import PATIENCE_S, Program, free_domain
from camera_test import preloaded

TYPE = "std_msgs::msg::dds_::ByteMultiArray_"
RECORD_S = 3            # SPDP comes each second
KEPT = 3000             # packets to tell of when the process dies
BATCH = 100             # packets between looks at how far the process is behind
SUBMESSAGES = (0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e, 0x0f, 0x12, 0x13, 0x15, 0x16, 0x30, 0x31, 0x32, 0x33, 0x34, 0x80)
NUMBERS = (0, 1, 2, 3, 4, 7, 8, 15, 16, 0x7f, 0x80, 0xff, 0x100, 0x7fff, 0x8000, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff)
LONGEST = 65507         # of a UDP packet
# (reader, writer) of discovery and of the liveliness of participants.
BUILTIN = ((0x100c7, 0x100c2), (0x3c7, 0x3c2), (0x4c7, 0x4c2), (0x200c7, 0x200c2), (0x300c4, 0x300c3))
PARAMETERS = (0, 1, 2, 5, 7, 0x0f, 0x15, 0x16, 0x1a, 0x1b, 0x1d, 0x1e, 0x23, 0x25, 0x27, 0x29, 0x2b, 0x2c, 0x2d, 0x2e, 0x2f, 0x30, 0x31, 0x32, 0x33,
              0x34, 0x35, 0x40, 0x41, 0x43, 0x44, 0x48, 0x49, 0x50, 0x52, 0x53, 0x55, 0x58, 0x59, 0x5a, 0x60, 0x62, 0x70, 0x71, 0x72, 0x73, 0x74, 0x75,
              0x77, 0x78, 0x1001, 0x1002, 0x8000, 0x8001, 0x8007, 0x8014, 0xc000)


def udp_ports(process_id):
    """{port: packets dropped by the kernel, bytes waiting} of all sockets of a process."""
    inodes = set()
    for descriptor in pathlib.Path(f"/proc/{process_id}/fd").iterdir():
        target = os.readlink(descriptor)
        if target.startswith("socket:["):
            inodes.add(target[8:-1])
    ports = {}
    for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]:
        words = line.split()
        if words[9] in inodes:
            ports[int(words[1].split(":")[1], 16)] = (int(words[12]), int(words[4].split(":")[1], 16))
    return ports


def recorded(path):
    data, packets, at = path.read_bytes(), [], 0
    while at + 4 <= len(data):
        size, = struct.unpack_from("<I", data, at)
        if at + 4 + size <= len(data):
            packets.append(data[at + 4:at + 4 + size])
        at += 4 + size
    return packets


def sample_of_each_kind(packets):
    """At most 100 packets of each sequence of submessages, so that the rare ones are not lost among messages and heartbeats."""
    kinds = collections.defaultdict(list)
    for packet in packets:
        kinds[tuple(kind for kind, _ in submessages(packet))].append(packet)
    return [packet for group in kinds.values() for packet in group[:100]]


def submessages(packet):
    """[(kind, bytes with header)] of a packet that is well formed."""
    found, at = [], 20
    while at + 4 <= len(packet):
        kind, flags = packet[at], packet[at + 1]
        length, = struct.unpack_from("<H" if flags & 1 else ">H", packet, at + 2)
        end = len(packet) if length == 0 and kind not in (0x01, 0x09) else at + 4 + length
        found.append((kind, packet[at:end]))
        at = end
    return found


class Garbage:
    """An endless source of packets, the same for the same seed and recording."""

    def __init__(self, seed, packets):
        self.chance = random.Random(seed)
        self.packets = packets
        self.parts = [part for packet in packets for _, part in submessages(packet)]
        # Whom recorded messages go to and come from, as they stand in them; those of discovery besides.
        self.ends = sorted({part[8:16] for part in self.parts if part[0] in (0x15, 0x16) and len(part) > 16}
                           | {part[4:12] for part in self.parts if part[0] in (0x06, 0x07) and len(part) > 12})
        self.ends += [struct.pack(">II", *ends) for ends in BUILTIN]
        self.kinds = (self.to_someone, self.to_someone, self.parameters, self.parameters, self.random_bytes, self.random_submessages, self.replayed, self.changed, self.changed, self.changed, self.changed,
                      self.cut, self.put_together, self.oversized, self.renamed)

    def next(self):
        make = self.chance.choice(self.kinds)
        return make.__name__, make()[:LONGEST]

    def random_bytes(self):
        return self.chance.randbytes(self.chance.choice((self.chance.randrange(64), self.chance.randrange(1500))))

    def header(self):
        if self.chance.random() < 0.5:
            return self.chance.choice(self.packets)[:20]
        return b"RTPS\2" + bytes([self.chance.choice((1, 2, 5, 255))]) + self.chance.randbytes(14)

    def random_submessages(self):
        packet = self.header()
        for _ in range(self.chance.randrange(1, 6)):
            body = self.chance.randbytes(self.chance.randrange(0, 120))
            length = self.chance.choice((len(body), len(body), self.chance.choice(NUMBERS) & 0xffff))
            flags = self.chance.randrange(256)
            packet += bytes([self.chance.choice(SUBMESSAGES), flags]) + struct.pack("<H" if flags & 1 else ">H", length) + body
        return packet

    def word(self):
        return struct.pack("<I", self.chance.choice((self.chance.choice(NUMBERS), self.chance.randrange(300), self.chance.randrange(2**32))))

    def to_someone(self):
        """Submessages that are well formed, for readers and writers there are, with any numbers in them."""
        packet = self.header()
        for _ in range(self.chance.randrange(1, 4)):
            kind = self.chance.choice((0x06, 0x07, 0x08, 0x12, 0x13, 0x15, 0x16))
            body = self.chance.choice(self.ends)
            if kind in (0x15, 0x16):
                body = b"\0\0" + struct.pack("<H", self.chance.choice((16, 28, 0, 4, 0xffff))) + body
            # The high half of a sequence number mostly is zero.
            body += self.chance.choice((bytes(4), bytes(4), self.word())) + b"".join(self.word() for _ in range(self.chance.randrange(1, 14)))
            packet += bytes([kind, self.chance.choice((1, 3, 5, 7, 9, 0x0d))]) + struct.pack("<H", len(body)) + body
        return packet

    def parameters(self):
        """A list of parameters as discovery sends them, with any content."""
        content = b"\0\3\0\0"
        for _ in range(self.chance.randrange(1, 12)):
            value = b"".join(self.word() for _ in range(self.chance.choice((0, 1, 1, 2, 3, 4, 6, 10))))
            length = self.chance.choice((len(value),) * 6 + (self.chance.choice(NUMBERS) & 0xffff,))
            content += struct.pack("<HH", self.chance.choice(PARAMETERS), length) + value
        content += self.chance.choice((struct.pack("<HH", 1, 0), b""))
        body = b"\0\0\x10\0" + struct.pack(">II", *self.chance.choice(BUILTIN)) + struct.pack("<II", 0, self.chance.randrange(1, 400)) + content
        return self.header() + b"\x15\5" + struct.pack("<H", len(body)) + body

    def replayed(self):
        return self.chance.choice(self.packets)

    def changed(self):
        packet = bytearray(self.chance.choice(self.packets))
        if not packet:
            return b""
        for _ in range(self.chance.randrange(1, 6)):
            # Most of what is decided by stands near the beginning.
            at = self.chance.randrange(min(len(packet), self.chance.choice((64, 300, LONGEST))))
            what = self.chance.randrange(4)
            if what == 0:
                packet[at] ^= 1 << self.chance.randrange(8)
            elif what == 1:
                packet[at] = self.chance.randrange(256)
            else:
                at -= at % (2 if what == 2 else 4)
                number = self.chance.choice(NUMBERS)
                word = struct.pack("<H", number & 0xffff) if what == 2 else struct.pack("<I", number)
                packet[at:at + len(word)] = word
        return bytes(packet)

    def cut(self):
        packet = self.chance.choice(self.packets)
        return packet[:self.chance.randrange(len(packet) + 1)]

    def put_together(self):
        packet = self.header()
        for _ in range(self.chance.randrange(1, 8)):
            packet += self.chance.choice(self.parts)
        return packet

    def oversized(self):
        packet = self.changed()
        return packet + self.chance.randbytes(16) * self.chance.randrange(1, self.chance.choice((10, 200, 4100)))

    def renamed(self):
        """From a participant that nobody knows."""
        packet = self.chance.choice(self.packets)
        return packet.replace(packet[8:20], self.chance.randbytes(4) + packet[12:20])


def resident_mb(process_id):
    for line in pathlib.Path(f"/proc/{process_id}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    return 0


def talk(bus, peer, topic):
    """New endpoints exchange messages, there and back."""
    for here, there, name in ((bus, peer, f"{topic}/there"), (peer, bus, f"{topic}/back")):
        assert here.ask(f"writer {name} {TYPE} reliable 10") == "ok"
        assert there.ask(f"reader {name} {TYPE} reliable 10") == "ok"
        for program, wish in ((here, f"readers {name} 1"), (there, f"writers {name} 1")):
            answer = program.ask(wish)
            assert answer == "ok", f"{wish}: {answer}"
        for seed in range(10):
            assert here.ask(f"pattern {name} {seed * 3000} {seed}") == "sent"
            message = there.ask(f"take {name} 1")
            body = bytes((i * 7 + i // 251 + seed) & 255 for i in range(seed * 3000))
            assert message == "00010000" + body.hex(), f"{name} {seed}: {message[:100]}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bus_peer")
    parser.add_argument("record_packets")
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--max-mb", type=float, default=200, help="more memory than before that is still bounded [MB]")
    options = parser.parse_args()

    domain = str(free_domain())
    with tempfile.TemporaryDirectory(prefix="tassilo_") as folder:
        file = pathlib.Path(folder) / "packets"
        environment = os.environ | {"LD_PRELOAD": preloaded(options.bus_peer, options.record_packets), "TASSILO_RECORD_PACKETS": str(file)}
        bus = Program(options.bus_peer, domain)
        neighbor = Program(options.bus_peer, domain, env=environment)
        assert bus.first == "ready" and neighbor.first == "ready", (bus.first, neighbor.first)
        for program, own, other in ((bus, "rt/a", "rt/b"), (neighbor, "rt/b", "rt/a")):
            for kind in ("reliable", "best_effort"):
                assert program.ask(f"writer {own}/{kind} {TYPE} {kind} 5") == "ok"
                assert program.ask(f"reader {other}/{kind} {TYPE} {kind} 5") == "ok"
        for program, own in ((bus, "rt/a"), (neighbor, "rt/b")):
            assert program.ask(f"stream {own}/reliable 200 20") == "ok"
            assert program.ask(f"stream {own}/best_effort 30000 100") == "ok"
        for kind in ("reliable", "best_effort"):
            assert bus.ask(f"take rt/b/{kind} 3") != "late"
        time.sleep(RECORD_S)
        packets = sample_of_each_kind(recorded(file))

        ports = sorted(udp_ports(bus.process.pid))
        garbage, sender = Garbage(options.seed, packets), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        dropped = {port: udp_ports(bus.process.pid)[port][0] for port in ports}
        last, counts, sizes = collections.deque(maxlen=KEPT), collections.Counter(), 0
        before_mb, begin = resident_mb(bus.process.pid), time.monotonic()
        most_mb = before_mb
        kinds = sorted({kind for packet in packets for kind, _ in submessages(packet)})
        print(f"recorded {len(packets)} packets with submessages {' '.join(map(hex, kinds))}; ports {ports}", flush=True)
        for number in range(options.count):
            kind, packet = garbage.next()
            port = ports[number % len(ports)]
            last.append((kind, port, packet))
            counts[kind] += 1
            sizes += len(packet)
            sender.sendto(packet, ("127.0.0.1", port))
            if number % BATCH == 0:
                end = time.monotonic() + PATIENCE_S
                while bus.process.poll() is None and any(waiting > 200_000 for _, waiting in udp_ports(bus.process.pid).values()):
                    assert time.monotonic() < end, f"after packet {number} it reads no more"
                if bus.process.poll() is not None:
                    if options.keep:
                        options.keep.write_bytes(b"".join(struct.pack("<II", p, len(b)) + b for _, p, b in last))
                    sys.exit(f"packet {number} or one of the {BATCH} before: the process ended with {bus.process.returncode}; "
                             f"the last ones were {[k for k, _, _ in list(last)[-20:]]}")
            if number % 10_000 == 0:
                most_mb = max(most_mb, resident_mb(bus.process.pid))
        seconds = time.monotonic() - begin
        after_mb = resident_mb(bus.process.pid)
        most_mb = max(most_mb, after_mb)
        now = udp_ports(bus.process.pid)
        lost = sum(now[port][0] - dropped[port] for port in ports)
        print(f"{options.count} packets, {sizes / 1e6:.0f} MB in {seconds:.1f} s, {lost} of them dropped by the kernel: {dict(counts)}")
        print(f"memory {before_mb:.0f} MB before, {after_mb:.0f} MB after, {most_mb:.0f} MB at most", flush=True)
        old = {kind: bus.ask(f"take rt/b/{kind} 1 3000") != "late" for kind in ("reliable", "best_effort")}
        print(f"the neighbor whose name was used is still heard: {old}")
        print(f"refused {bus.ask('refused rt/b/reliable')}, lost {bus.ask('lost rt/b/reliable')} and {bus.ask('lost rt/b/best_effort')}")
        print(f"complaints: {bus.ask('complaints')[:600]}", flush=True)

        newcomer = Program(options.bus_peer, domain)
        talk(bus, newcomer, "rt/after")
        newcomer.close()
        print(f"memory {resident_mb(bus.process.pid):.0f} MB after a newcomer was talked to", flush=True)
        assert most_mb - before_mb < options.max_mb, f"memory grew from {before_mb:.0f} to {most_mb:.0f} MB"
        neighbor.process.kill()
        bus.close()
        assert bus.process.returncode == 0, f"ended with {bus.process.returncode}"


if __name__ == "__main__":
    main()
