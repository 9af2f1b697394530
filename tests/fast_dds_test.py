#!/usr/bin/env python3
"""The team bus against another implementation of DDS, Fast DDS, in both directions: every value of every message.

The bytes on Tassilo's side are made and read here, field by field as the CDR of ROS 2 says.

usage: tests/fast_dds_test.py BUS_PEER FAST_DDS_PEER [unittest arguments]
"""
import json
import math
import random
import struct
import sys
import time
import unittest

from bus_peer import PATIENCE_S, Program, free_domain

POSE = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_"
SCAN = "sensor_msgs::msg::dds_::LaserScan_"
IMAGE = "sensor_msgs::msg::dds_::CompressedImage_"
SCAN_FLOATS = ("angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max")


class Encoder:
    """CDR, little endian: each number at a multiple of its size, counted from after the header."""

    def __init__(self):
        self.bytes = bytearray()

    def numbers(self, kind, values):
        size = struct.calcsize("<" + kind)
        if values:
            self.bytes += bytes(-len(self.bytes) % size)
        for value in values:
            self.bytes += struct.pack("<" + kind, value)

    def sequence(self, kind, values):
        self.numbers("I", [len(values)])
        self.numbers(kind, values)

    def text(self, value):
        self.sequence("B", value.encode() + b"\0")

    def message(self):
        return b"\0\1\0\0" + bytes(self.bytes)


class Decoder:
    def __init__(self, message):
        assert message[:2] in (b"\0\1", b"\0\0"), message[:4]
        self.order = "<" if message[1] else ">"
        self.bytes, self.at = message[4:], 0

    def numbers(self, kind, count):
        form = struct.Struct(f"{self.order}{count}{kind}")
        if count:
            self.at += -self.at % struct.calcsize("<" + kind)
        values = list(form.unpack_from(self.bytes, self.at))
        self.at += form.size
        return values

    def sequence(self, kind):
        return self.numbers(kind, self.numbers("I", 1)[0])

    def text(self):
        return bytes(self.sequence("B")[:-1]).decode()


def encode(kind, value):
    cdr = Encoder()
    cdr.numbers("i", [value["sec"]])
    cdr.numbers("I", [value["nanosec"]])
    cdr.text(value["frame_id"])
    if kind == "pose":
        cdr.numbers("d", value["position"] + value["orientation"] + value["covariance"])
    elif kind == "scan":
        cdr.numbers("f", [value[name] for name in SCAN_FLOATS])
        cdr.sequence("f", value["ranges"])
        cdr.sequence("f", value["intensities"])
    else:
        cdr.text(value["format"])
        cdr.sequence("B", bytes.fromhex(value["data"]))
    return cdr.message()


def decode(kind, message):
    cdr = Decoder(message)
    value = {"sec": cdr.numbers("i", 1)[0], "nanosec": cdr.numbers("I", 1)[0], "frame_id": cdr.text()}
    if kind == "pose":
        value |= {"position": cdr.numbers("d", 3), "orientation": cdr.numbers("d", 4), "covariance": cdr.numbers("d", 36)}
    elif kind == "scan":
        value |= dict(zip(SCAN_FLOATS, cdr.numbers("f", 7)))
        value |= {"ranges": cdr.sequence("f"), "intensities": cdr.sequence("f")}
    else:
        value |= {"format": cdr.text(), "data": bytes(cdr.sequence("B")).hex()}
    return value


def random_value(kind, seed):
    """Any values a message can have; frame ids of every length, so that what follows stands at every place."""
    chance = random.Random(seed)
    single = lambda: struct.unpack("<f", struct.pack("<f", chance.gauss(0, 10)))[0]
    value = {"sec": chance.randint(-2**31, 2**31 - 1), "nanosec": chance.randint(0, 10**9 - 1), "frame_id": "field/äöü"[:seed % 10]}
    if kind == "pose":
        covariance = [chance.gauss(0, 1) for _ in range(36)]
        covariance[seed % 36] = math.inf
        value |= {"position": [chance.gauss(0, 4) for _ in range(3)], "orientation": [chance.random() for _ in range(4)], "covariance": covariance}
    elif kind == "scan":
        count = seed * 37 % 400
        value |= {name: single() for name in SCAN_FLOATS}
        value |= {"ranges": [math.inf if i % 5 == seed % 5 else single() for i in range(count)], "intensities": [single() for _ in range(seed % 3)]}
    else:
        value |= {"format": "jpeg", "data": chance.randbytes(100_000 + seed).hex()}
    return value


def as_text(value):
    """Numbers that are not finite as the stranger writes them."""
    if isinstance(value, dict):
        return {key: as_text(item) for key, item in value.items()}
    if isinstance(value, list):
        return [as_text(item) for item in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


class FastDds(unittest.TestCase):
    ours, theirs = None, None  # programs, set by main

    @classmethod
    def setUpClass(cls):
        domain = str(free_domain())
        cls.bus = Program(cls.ours, domain)
        cls.addClassCleanup(cls.bus.close)
        cls.stranger = Program(cls.theirs, domain)
        cls.addClassCleanup(cls.stranger.close)
        assert cls.bus.first == "ready" and json.loads(cls.stranger.first) == {"ready": True}, (cls.bus.first, cls.stranger.first)

    def ask_stranger(self, **wish):
        answer = json.loads(self.stranger.ask(json.dumps(wish)))
        self.assertNotIn("error", answer, wish)
        return answer

    def until(self, found):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            value = found()
            if value:
                return value
            time.sleep(0.01)
        self.fail("waited in vain")

    def both_ways(self, kind, type_name, reliable, count):
        ours = "reliable" if reliable else "best_effort"
        out, back = f"rt/{kind}_{ours}/out", f"rt/{kind}_{ours}/back"
        self.assertEqual(self.bus.ask(f"writer {out} {type_name} {ours} 5"), "ok")
        self.assertEqual(self.bus.ask(f"reader {back} {type_name} {ours} 5"), "ok")
        self.ask_stranger(do="reader", topic=out, type=kind, reliable=reliable)
        self.ask_stranger(do="writer", topic=back, type=kind, reliable=reliable)
        self.assertEqual(self.bus.ask(f"readers {out} 1"), "ok")
        self.assertEqual(self.bus.ask(f"writers {back} 1"), "ok")
        self.until(lambda: self.ask_stranger(do="matched", topic=out) == {"writers": 1})
        self.until(lambda: self.ask_stranger(do="matched", topic=back) == {"readers": 1})
        for seed in range(count):
            # What is not reliable may be lost and is sent again. So may be, between these two, the first message after they have found
            # each other: the one does not yet listen when the other already counts.
            wait_s = PATIENCE_S if reliable and seed > 0 else 1
            with self.subTest(kind=kind, reliable=reliable, seed=seed):
                value = random_value(kind, seed)
                message = encode(kind, value).hex()

                def sent_and_taken():
                    self.assertEqual(self.bus.ask(f"send {out} {message}"), "sent")
                    end = time.monotonic() + wait_s
                    while time.monotonic() < end:
                        taken = self.ask_stranger(do="take", topic=out)["value"]
                        if taken:
                            return taken
                    return None
                self.assertEqual(self.until(sent_and_taken), as_text(value))
                while self.ask_stranger(do="take", topic=out)["value"]:
                    pass

                def sent_back_and_taken():
                    self.assertEqual(self.ask_stranger(do="send", topic=back, value=as_text(value)), {"ok": True})
                    answer = self.bus.ask(f"take {back} 1 {wait_s * 1000}")
                    return None if answer == "late" else answer
                taken = bytes.fromhex(self.until(sent_back_and_taken).split()[-1])
                self.assertEqual(as_text(decode(kind, taken)), as_text(value))
                # Nothing is behind it but padding to whole words; the gaps between its fields are anything.
                self.assertIn(len(taken) - len(message) // 2, range(4))

    def test_pose_with_covariance(self):
        self.both_ways("pose", POSE, reliable=False, count=10)
        self.both_ways("pose", POSE, reliable=True, count=10)

    def test_laser_scan(self):
        self.both_ways("scan", SCAN, reliable=False, count=10)
        self.both_ways("scan", SCAN, reliable=True, count=10)

    def test_image_in_many_packets(self):
        self.both_ways("image", IMAGE, reliable=False, count=4)
        self.both_ways("image", IMAGE, reliable=True, count=4)

    def test_what_the_stranger_publishes_is_found(self):
        self.ask_stranger(do="writer", topic="rt/robot7/pose", type="pose", reliable=False)
        self.until(lambda: f"rt/robot7/pose {POSE} " in self.bus.ask("publications -"))


if __name__ == "__main__":
    FastDds.ours, FastDds.theirs = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
