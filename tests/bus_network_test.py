#!/usr/bin/env python3
"""The team bus between two machines: network namespaces with a cable between them, which end with the test.

usage: tests/bus_network_test.py BUS_PEER [unittest arguments]
"""
import os
import shutil
import subprocess
import sys
import time
import unittest

from bus_peer import Program
from program import skip

TYPE = "std_msgs::msg::dds_::ByteMultiArray_"
HERE, THERE = "10.77.0.1", "10.77.0.2"


def run(*command):
    subprocess.run(command, check=True)


class Network(unittest.TestCase):
    program = None  # set by main

    @classmethod
    def setUpClass(cls):
        # The other machine: a process that holds its namespace.
        cls.other = subprocess.Popen(["unshare", "--net", "sh", "-c", "ip link set lo up && echo up && exec sleep 300"], stdout=subprocess.PIPE)
        cls.addClassCleanup(cls.other.communicate)
        cls.addClassCleanup(cls.other.kill)
        cls.other.stdout.readline()
        run("ip", "link", "set", "lo", "up")
        run("ip", "link", "add", "cable", "type", "veth", "peer", "name", "cable", "netns", str(cls.other.pid))
        run("ip", "address", "add", f"{HERE}/24", "dev", "cable")
        run("ip", "link", "set", "cable", "up")
        run(*cls.there(), "ip", "address", "add", f"{THERE}/24", "dev", "cable")
        run(*cls.there(), "ip", "link", "set", "cable", "up")

    @classmethod
    def there(cls):
        return ["nsenter", f"--net=/proc/{cls.other.pid}/ns/net"]

    def peer(self, *options, there=False):
        program = Program(*(self.there() if there else []), self.program, "5", *options)
        self.addCleanup(program.close)
        self.assertEqual(program.first, "ready")
        return program

    def talk(self, one, two):
        for here, there, topic in ((one, two, "rt/out"), (two, one, "rt/back")):
            self.assertEqual(here.ask(f"writer {topic} {TYPE} reliable 5"), "ok")
            self.assertEqual(there.ask(f"reader {topic} {TYPE} reliable 5"), "ok")
            self.assertEqual(here.ask(f"readers {topic} 1"), "ok")
            self.assertEqual(there.ask(f"writers {topic} 1"), "ok")
            self.assertEqual(here.ask(f"pattern {topic} 100000 3"), "sent")
            self.assertEqual(len(there.ask(f"take {topic} 1")), 2 * 100_004)

    def test_machines_find_each_other_by_multicast(self):
        self.talk(self.peer("cable", "multicast"), self.peer("cable", "multicast", there=True))

    def test_machines_find_each_other_by_names_of_peers(self):
        # One that knows of the other is enough.
        self.talk(self.peer("cable", THERE), self.peer("cable", there=True))

    def test_an_interface_may_be_named_by_its_address(self):
        self.talk(self.peer(HERE, THERE), self.peer(THERE, there=True))

    def test_processes_of_one_machine_find_each_other_by_multicast(self):
        self.talk(self.peer("cable", "multicast"), self.peer("cable", "multicast"))

    def test_processes_of_one_machine_find_each_other_without_multicast(self):
        self.talk(self.peer("cable"), self.peer("cable"))

    def test_who_is_on_loopback_is_not_found_from_elsewhere(self):
        listener = self.peer("lo")
        seeker = self.peer("cable", HERE, there=True)
        self.assertEqual(seeker.ask(f"writer rt/out {TYPE} best_effort 1"), "ok")
        # Long enough for three rounds of discovery; the packets do arrive, and the kernel drops them.
        end = time.monotonic() + 3.5
        while time.monotonic() < end:
            self.assertNotIn("rt/out", listener.ask("publications -"))
            time.sleep(0.1)
        with open("/proc/net/udp", encoding="ascii") as table:
            dropped = {int(line.split()[1].split(":")[1], 16): int(line.split()[-1]) for line in list(table)[1:]}
        self.assertGreater(dropped[7400 + 250 * 5 + 10], 0)
        # On the same interface it is found.
        self.assertEqual(self.peer("cable").ask(f"reader rt/out {TYPE} best_effort 1"), "ok")
        self.assertEqual(seeker.ask("readers rt/out 1"), "ok")


if __name__ == "__main__":
    if "TASSILO_IN_NAMESPACE" not in os.environ:
        inside = ["unshare", "--user", "--map-root-user", "--net"]
        if not all(map(shutil.which, ("unshare", "nsenter", "ip"))) or subprocess.run([*inside, "true"], capture_output=True).returncode:
            skip("network namespaces cannot be made here")
        os.environ["TASSILO_IN_NAMESPACE"] = "1"
        os.execvp(inside[0], [*inside, sys.executable, *sys.argv])
    Network.program = sys.argv[1]
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
