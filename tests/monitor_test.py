#!/usr/bin/env python3
"""`tassilo monitor` as browsers ask it, with live traffic of several processes on the bus, well-behaved and not.

usage: tests/monitor_test.py PROGRAM TEAM_TRAFFIC [unittest arguments]
"""
import http.client
import json
import math
import re
import signal
import subprocess
import sys
import time
import unittest

from bus_peer import free_domain
from program import DATA, TIMEOUT_S, ProgramTest, main
from serve_test import Channel

RECORDING = DATA / "d01_approach"


class Watched(ProgramTest):
    """A monitor to ask, and robots that talk; other tests of it begin with this, too."""

    traffic = None  # the program that talks

    def setUp(self):
        self.domain = free_domain()
        self.running = []
        self.addCleanup(self.end_all)

    def end_all(self):
        for process in self.running:
            process.kill()
            process.wait()
            for stream in (process.stdout, process.stderr):
                if stream is not None:
                    stream.close()

    def monitor(self, *arguments):
        """Starts the monitor; `self.port` is where it is asked."""
        self.process = self.start("monitor", "--port", "0", *arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.running.append(self.process)
        for line in self.process.stdout:
            if found := re.search(r"http://127\.0\.0\.1:(\d+)/", line):
                self.port = int(found[1])
                return
        self.fail(self.process.stderr.read())

    def live(self, *arguments):
        self.monitor("--domain", self.domain, *arguments)

    def talk(self, robots, *arguments):
        """Robots on the bus, in a process of their own."""
        process = subprocess.Popen([self.traffic, "--domain", str(self.domain), "--robots", robots, *map(str, arguments)], stderr=subprocess.PIPE)
        self.running.append(process)
        return process

    def ask(self, path, status=200):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT_S)
        connection.request("GET", path)
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        self.assertEqual(answer.status, status, (path, body[:300]))
        return json.loads(body) if answer.getheader("Content-Type") == "application/json" else body

    def picture(self, at=None):
        end = self.ask("/api/monitor")["end"]
        return self.ask(f"/api/monitor/at?t={end if at is None else at}")

    def robots(self):
        return {robot["id"]: robot for robot in self.picture()["robots"]} if self.ask("/api/monitor")["end"] else {}

    def wait_for(self, what, holds, seconds=TIMEOUT_S / 2):
        """What `holds` returns once it is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := holds():
                return found
            self.assertIsNone(self.process.poll(), "the monitor has ended")
            time.sleep(.1)
        self.fail(f"not within {seconds} s: {what}; {json.dumps(self.robots())[:2000]}; {self.ask('/api/monitor/news')}")

    def end(self):
        """Ends the monitor as Ctrl-C does; what it said."""
        self.process.send_signal(signal.SIGINT)
        out, err = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual((self.process.returncode, err), (0, ""), out)
        return out

    def knows_what_is_true(self, picture, robots):
        """The ball that all robots of team_traffic see, and their only opponent, where that program puts them."""
        t, ball, opponents = picture["t"], picture["team_ball"], picture["opponents"]
        off = math.hypot(ball["x"] - 1.5 * math.cos(.3 * t), ball["y"] - .8 * math.sin(.5 * t))
        self.assertLess(off, .2, picture["team_ball"])
        self.assertLess(ball["age"], 1)
        self.assertLessEqual(set(ball["robots"]), robots)
        self.assertGreaterEqual(len(ball["robots"]), 2)
        self.assertEqual(len(ball["cov"]), 16)
        # Nobody alone knows it better than his pose: 0.1 m and 0.045 rad.
        self.assertLess(math.sqrt(ball["cov"][0] + ball["cov"][5]), .15)
        self.assertEqual([one["team"] for one in opponents], ["magenta"])
        self.assertLess(math.hypot(opponents[0]["x"] + 1, opponents[0]["y"] - .5), .2)

    def news(self):
        return [(one["robot"], one["text"]) for one in self.ask("/api/monitor/news")]


class Monitor(Watched):
    def test_ten_robots_of_several_processes_are_shown(self):
        self.live()
        for robots in ("1,2,3,4", "5,6,7", "8,9,10"):
            self.talk(robots)
        robots = self.wait_for("ten robots", lambda: (r := self.robots()) and len(r) == 10 and
                               all(one["scene"]["pose"] and one["loss"] is not None for one in r.values()) and r)
        for robot in robots.values():
            self.assertEqual(robot["presence"], "here")
            self.assertEqual(robot["team"], "cyan")
            self.assertIn(robot["role"], ("goalkeeper", "defender", "striker"))
            self.assertEqual(len(robot["scene"]["balls"]), 1)
            self.assertEqual(len(robot["scene"]["free_space"]["ranges"]), 61)
            self.assertLess(abs(robot["clock_offset"]), 1)
            self.assertEqual(robot["refused"], 0)
            self.assertEqual(robot["troubles"], [])
            self.assertTrue(robot["has_picture"])
        channel = Channel(self.port, "team")
        times = []
        for _ in range(20):
            is_text, message = channel.receive()
            self.assertTrue(is_text)
            picture = json.loads(message)
            times.append(picture["t"])
        channel.close()
        self.assertEqual(times, sorted(times))
        self.assertEqual(picture["counts"]["refused"], 0)
        self.knows_what_is_true(picture, set(robots))
        # Looking back: what was, and where everybody came from.
        monitor = self.ask("/api/monitor")
        self.assertEqual(monitor["mode"], "live")
        self.assertEqual(monitor["field"]["length"], 8.22)
        middle = (monitor["begin"] + monitor["end"]) / 2
        then = self.picture(middle)
        self.assertLessEqual(then["t"], middle)
        self.assertLess(middle - then["t"], 1)
        self.knows_what_is_true(then, set(robots))
        trails = self.ask(f"/api/monitor/trails?t={monitor['end']}&seconds=2")["robots"]
        self.assertEqual({trail["id"] for trail in trails}, set(range(1, 11)))
        for trail in trails:
            self.assertLessEqual(len(trail["points"]), 22)
        self.ask(f"/api/monitor/at?t={monitor['begin'] - 10}", 404)
        self.ask("/api/monitor/at", 400)
        self.ask("/api/monitor/at?t=nan", 400)
        self.ask("/api/monitor/trails?t=0&seconds=61", 400)
        self.ask("/api/nothing", 404)
        self.assertIn("0 refused", self.end())

    def test_pictures_come_while_somebody_looks(self):
        self.live()
        self.talk("4")
        self.wait_for("the robot", lambda: self.robots().get(4, {}).get("has_picture"))
        channel = Channel(self.port, "picture4")
        for _ in range(3):
            is_text, picture = channel.receive()
            self.assertFalse(is_text)
            self.assertTrue(picture.startswith(b"\xff\xd8"))
        channel.close()
        # Nobody else is told more than there is.
        quiet = Channel(self.port, "picture5")
        self.assertEqual(quiet.status, 101)
        quiet.close()

    def test_robots_come_go_and_start_again_with_another_clock(self):
        self.live()
        stays, goes = self.talk("1"), self.talk("2,3")
        self.wait_for("three robots", lambda: len(self.robots()) == 3)
        goes.kill()
        goes.wait()
        self.wait_for("silence", lambda: {self.robots()[robot]["presence"] for robot in (2, 3)} == {"gone"})
        self.assertEqual(self.robots()[1]["presence"], "here")
        self.assertEqual(self.picture()["team_ball"]["robots"], [1])
        self.assertIn((2, "is gone: silent for 5 s"), self.news())
        self.talk("2", "--clock-ahead", -3600)
        robot = self.wait_for("the robot again", lambda: (r := self.robots()[2])["presence"] == "here" and r["scene"]["balls"] and r)
        self.assertAlmostEqual(robot["clock_offset"], -3600, delta=1)
        self.assertTrue(any("3600.0 s behind" in trouble or "3599.9 s behind" in trouble for trouble in robot["troubles"]), robot["troubles"])
        self.assertIn((2, "was started again, or another has taken its number"), self.news())
        self.assertIsNone(stays.poll())

    def test_two_with_one_number_and_one_of_another_time(self):
        self.live()
        self.talk("7")
        self.wait_for("the robot", lambda: self.robots().get(7))
        self.talk("7", "--clock-ahead", 600)
        self.talk("8", "--clock-ahead", 600)
        self.wait_for("two senders", lambda: "two senders have its number" in self.robots()[7]["troubles"])
        self.wait_for("another clock", lambda: any("s ahead" in trouble for trouble in self.robots().get(8, {}).get("troubles", [])))
        robots = self.robots()
        self.assertLess(abs(robots[7]["clock_offset"]), 1)
        self.assertAlmostEqual(robots[8]["clock_offset"], 600, delta=1)
        self.assertTrue(robots[8]["scene"]["balls"])
        self.assertGreater(robots[7]["refused"], 0)

    def test_garbage_is_told_counted_and_harms_nobody(self):
        self.live()
        self.talk("1")
        self.talk("1,2", "--garbage")
        self.wait_for("garbage", lambda: any("cannot be believed" in trouble for trouble in self.robots().get(2, {}).get("troubles", [])))
        self.wait_for("the other one", lambda: self.robots().get(1, {}).get("scene", {}).get("balls"))
        self.wait_for("more garbage", lambda: self.picture()["counts"]["refused"] > 100)
        self.assertFalse(self.robots()[2]["scene"]["balls"])
        self.assertEqual(self.picture()["team_ball"]["robots"], [1])
        self.assertRegex(self.end(), r"[1-9]\d* refused")

    def test_strangers_are_not_believed_when_the_team_is_known(self):
        self.live("--robots", "1,2")
        self.talk("1,9")
        self.wait_for("the robot", lambda: self.robots().get(1))
        self.wait_for("the stranger", lambda: self.picture()["troubles"])
        self.assertNotIn(9, self.robots())

    def test_what_is_heard_is_recorded_looked_at_and_sent_again(self):
        self.live("--record", "team.mcap")
        self.talk("1,2,3")
        self.wait_for("three robots", lambda: len(self.robots()) == 3)
        time.sleep(3)
        self.assertIn("log: team.mcap", self.end())
        self.end_all()
        self.monitor("team.mcap")
        monitor = self.ask("/api/monitor")
        self.assertEqual((monitor["mode"], monitor["damage"]), ("log", ""))
        self.assertGreater(monitor["end"] - monitor["begin"], 2)
        first, last = self.picture(monitor["begin"] + 1), self.picture(monitor["end"])
        self.assertTrue(self.picture(monitor["begin"])["robots"], "the first message of a log is heard")
        news = [(one["number"], one["t"], one["text"]) for one in self.ask("/api/monitor/news")]
        self.picture(monitor["end"])
        self.picture(monitor["begin"] + 1)
        self.assertLessEqual(set(news), {(one["number"], one["t"], one["text"]) for one in self.ask("/api/monitor/news")})
        for picture in (first, last, self.picture(monitor["begin"] + 1)):
            self.assertEqual([robot["id"] for robot in picture["robots"]], [1, 2, 3])
            self.knows_what_is_true(picture, {1, 2, 3})
        again = self.picture(monitor["begin"] + 1)
        for what in ("robots", "team_ball", "opponents"):
            self.assertEqual(first[what], again[what])
        self.assertNotEqual(first["robots"][0]["scene"]["pose"]["x"], last["robots"][0]["scene"]["pose"]["x"])
        self.ask(f"/api/monitor/picture?t={monitor['end']}&robot=1", 404)
        self.ask(f"/api/monitor/picture?t={monitor['end']}&robot=1.5", 400)
        self.end()
        # On another domain: what is still published here would be in the way.
        self.domain = free_domain()
        self.live()
        replay = self.start("replay", "team.mcap", "--domain", self.domain, "--speed", "2", "--loop", "-q")
        self.running.append(replay)
        robots = self.wait_for("three robots again", lambda: len(r := self.robots()) == 3 and all(one["scene"]["balls"] for one in r.values()) and r)
        self.assertLess(abs(robots[1]["clock_offset"]), 1)  # as if it were now
        replay.send_signal(signal.SIGINT)
        self.assertEqual(replay.wait(TIMEOUT_S), 0)

    def test_what_garbage_left_in_a_log_is_sent_again_as_it_was(self):
        self.live("--record", "garbage.mcap")
        self.talk("1")
        self.talk("2", "--garbage")
        self.wait_for("garbage", lambda: self.picture()["counts"]["refused"] > 50 if self.ask("/api/monitor")["end"] else False)
        self.end()
        self.end_all()
        for speed in ("4", "0.5"):
            result = self.succeeds("replay", "garbage.mcap", "--domain", free_domain(), "--speed", speed, "--duration", "1")
            self.assertRegex(result.out, r"[1-9]\d* messages sent")

    def test_a_run_is_shown(self):
        self.write("robot.yaml", f"robot: {{id: 6, team: magenta}}\ncamera: {RECORDING / 'camera.yaml'}\nfield: msl98\n")
        self.live()
        seen = []
        run = self.start("run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry",
                         RECORDING / "odometry.jsonl", "--bus", "--domain", self.domain, stdout=subprocess.PIPE, text=True)
        self.running.append(run)
        self.wait_for("the robot", lambda: (r := self.robots().get(6)) and r["scene"]["pose"] and r["team"] != "unknown" and seen.append(r) is None)
        self.assertEqual(seen[0]["team"], "magenta")
        out, _ = run.communicate(timeout=TIMEOUT_S)
        self.assertEqual(run.returncode, 0)
        self.assertRegex(out, r"bus: \d+ messages as robot 6")

    def test_wrong_usage_is_refused(self):
        self.refuses("monitor", "nothing.mcap", says="nothing.mcap")
        self.refuses("replay", says="log")
        self.write("no.mcap", "this is no log at all")
        self.fails("replay", "no.mcap", says="no.mcap")
        self.fails("monitor", "no.mcap", says="no.mcap")
        self.fails("monitor", "--interface", "nowhere0", "--domain", self.domain, says="nowhere0")
        self.fails("monitor", "--field", "moon", says="moon")
        self.refuses("monitor", "--domain", "233", says="--domain")


if __name__ == "__main__":
    Watched.traffic = sys.argv.pop(2)
    main()
