"""Answers of the command, and tables made of them."""
import csv
import json
import os
import subprocess
import sys


class Detp:
    """The command whose path is the script's first argument."""

    def __init__(self, documentation):
        if len(sys.argv) < 2:
            sys.exit(documentation)
        self.path = sys.argv[1]
        self.quick = "--quick" in sys.argv

    def ask(self, line):
        """The answer of `detp LINE` as JSON."""
        words = [self.path, *line.split(), "--format", "json", "--quiet"]
        return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout)


class Table:
    """Rows of CSV, written at once: after those that the file `path` has; to the file of --output, complete or not at all; or to standard output."""

    def __init__(self, columns, path=None):
        self.kept = []
        self.output = None if path or "--output" not in sys.argv else sys.argv[sys.argv.index("--output") + 1]
        if path and os.path.exists(path):
            with open(path) as file:
                self.kept = list(csv.DictReader(file))
        self.file = open(path, "a") if path else open(self.output + ".part", "w") if self.output else sys.stdout
        self.rows = csv.writer(self.file, lineterminator="\n")
        if not self.kept:
            self.add(*columns.split(","))

    def add(self, *values):
        self.rows.writerow([self.text(value) for value in values])
        self.file.flush()

    def done(self):
        if self.output:
            os.replace(self.output + ".part", self.output)

    @staticmethod
    def text(value):
        if value is None:
            return ""
        if isinstance(value, bool):
            return str(value).lower()
        return f"{value:.5g}" if isinstance(value, float) else value
