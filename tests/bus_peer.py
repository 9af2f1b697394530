"""What the tests of the team bus share: a domain of their own, and programs that answer line by line."""
import socket
import subprocess

PATIENCE_S = 30  # something hangs, whatever the machine and the sanitizer
held = []  # names of domains, to the end of this process


def free_domain():
    """A domain that no other test of this machine uses while this process lives; src/tassilo/team/bus_test.cpp does the same."""
    for domain in range(1, 101):
        holder = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            holder.bind(f"\0tassilo bus test {domain}")
        except OSError:
            holder.close()
            continue
        held.append(holder)
        return domain
    raise RuntimeError("all domains are in use")


class Program:
    """A peer, which answers each line with one."""

    def __init__(self, *command, **options):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, **options)
        self.first = self.process.stdout.readline().strip()

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().rstrip("\n")

    def close(self):
        self.process.stdin.close()
        self.process.wait(PATIENCE_S)
        self.process.stdout.close()
