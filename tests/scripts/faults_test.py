#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes writes and reads of psi-slam fail, kills it, and checks what it leaves.

    faults_test.py BUILD SOURCE [--every N] [--kills N] [--commands NAME...] [--only KIND...] [--jobs N]

Maps, resumes, merges, localizes and compares maps of a short simulated log in a folder that has older results. Every call that
writes a file fails in turn with ENOSPC (as do all later ones that need space), with EIO, or after half of its bytes. Before every such
call, psi-slam is also killed. Then reads of the log fail, the log is truncated while it is read, and the clock is set back. At last
psi-slam is killed at random moments, again and again in the same folders.

Each file must then be whole: that of the older results, or that of a run without fault. psi-slam must print one sentence with the name
of the file and the reason, return the right exit code, and leave no temporary file unless it was killed.

--every N tests every N-th call only; --kills N is the number of kills at random moments; --only chooses among writes, reads, clock
and kills.
"""
import argparse
import collections
import concurrent.futures
import gzip
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PARTIAL = re.compile(r"\.partial-\d+-[0-9a-f]{16}(-|$)")
REASONS = {"enospc": "No space left on device", "short": "No space left on device", "eio": "Input/output error"}
TIMED = {"frames.csv", "loops.csv", "summary.json", "report.html"}  # state times, so no two runs give the same bytes
SETTINGS = {
    "new": "[map]\nwrite_geotiff = true\nwrite_gpkg = true\nepsg = 25832\norigin_easting_m = 500000\n"
           "origin_northing_m = 5500000\n",
    "old": "[map]\nresolution_m = 0.1\nwrite_dxf = false\nwrite_geotiff = true\nepsg = 25832\n",
}
KILLS_IN_FOLDER = 50
MAPPING = ("map", "resume", "merge")  # commands that write a whole map
EDITS = "keep_out polygon=0.5,-0.5;1,-0.5;1,0.5;0.5,0.5\nslow polygon=1,-0.5;2,-0.5;2,0.5 percent=40\n"

Command = collections.namedtuple("Command", "name words")
Run = collections.namedtuple("Run", "code err calls duration_s")
Call = collections.namedtuple("Call", "number name path failed")


class Fault(Exception):
    """psi-slam did not keep its promise."""


def commands(inputs, variant):
    """The commands with their outputs in the current folder. `variant` names the settings."""
    settings = ["-c", str(inputs / f"{variant}.ini")]
    log, rest, late, session, grid = (str(inputs / name) for name in (
        "log.clf", "rest.clf", "late.clf", "first.session", "grid/map.yaml"))
    edits = ["--edits", str(inputs / "zones.edits")] if variant == "new" else []
    seed = ["--set", "run.seed=" + ("1" if variant == "new" else "2")]
    to = ["-o", "out", "--force"]
    map_words = [log, *settings, *seed, *edits, *to, "--save-session", "s.session"]
    return [
        Command("map", [*map_words, "--journal", "j.journal"]),
        Command("resume", ["--resume", session, rest, *settings, *to, "--save-session", "s.session"]),
        Command("merge", ["merge", log, late, "--start", "0.3,0,0", *settings, *seed, *to]),
        Command("localize", ["localize", grid, log if variant == "new" else late, *to]),
        Command("diff", ["diff", str(inputs / "old_grid/map.yaml") if variant == "new" else grid, grid, *to]),
    ]


def files_in(folder):
    """Bytes of all files below a folder, by relative path."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def partial_folders_in(folder):
    return [path for path in folder.rglob("*") if path.is_dir() and PARTIAL.match(path.name)]


def is_whole(name, content, model):
    """Whether a file that states times is complete, compared with the same file of another run."""
    if name == "summary.json":
        return json.loads(content).keys() == json.loads(model).keys()
    if name == "report.html":
        return content.rstrip().endswith(b"</html>")
    commas = [[line.count(b",") for line in text.split(b"\n")[:-1]] for text in (content, model)]
    return content.endswith(b"\n") and commas[0] == commas[1]


def sort_out(folder, before, after, killed):
    """Says for each file in a folder whether it is old, new, or the same in both results. Raises Fault if it is none of these or
    is missing."""
    kinds = {}
    if not killed and partial_folders_in(folder):
        raise Fault(f"{partial_folders_in(folder)} was left")
    for name, content in files_in(folder).items():
        parts = name.split("/")
        is_partial = any(PARTIAL.match(part) for part in parts)
        if is_partial and killed:
            continue
        if is_partial or any(part.startswith(".") for part in parts):
            raise Fault(f"the temporary file {name} was left")
        if before.get(name) == content:
            kinds[name] = "same" if after.get(name) == content else "old"
        elif name == "j.journal" and content.startswith(b"psi-slam journal"):
            kinds[name] = "journal"
        elif name not in after:
            raise Fault(f"{name} belongs to no results")
        elif content == after[name] or (Path(name).name in TIMED and is_whole(Path(name).name, content, after[name])):
            kinds[name] = "new"
        else:
            raise Fault(f"{name} has {len(content)} bytes that belong to neither results")
    gone = [name for name in before if name in after and name not in kinds]
    if gone:
        raise Fault(f"{gone} vanished")
    return kinds


class Tests:
    def __init__(self, build, source, work, options, pool):
        self.program = build / "apps/psi-slam/psi-slam"
        self.inputs = work / "inputs"
        self.work = work
        self.options = options
        self.pool = pool
        self.tasks = []
        self.failing_system = work / "failing_system.so"
        self.counts = collections.Counter()
        self.failures = []
        self.known = {}
        subprocess.run(["cc", "-shared", "-fPIC", "-O2", "-o", self.failing_system, source / "tests/scripts/failing_system.c", "-ldl"],
                       check=True)
        self.bench = build / "apps/psi-slam-bench/psi-slam-bench"

    def can_preload(self):
        """Sanitizers do not work with preloaded libraries."""
        environment = dict(os.environ, LD_PRELOAD=str(self.failing_system))
        subprocess.run([self.program, "--version"], check=True, capture_output=True)
        return subprocess.run([self.program, "--version"], env=environment, capture_output=True).returncode == 0

    def make_inputs(self):
        self.inputs.mkdir()
        simulated = self.inputs / "simulated.clf.gz"
        subprocess.run([self.bench, "simulate", "--path-m", "20", "--write-log", simulated], check=True, stdout=subprocess.DEVNULL)
        lines = gzip.decompress(simulated.read_bytes()).decode().splitlines(keepends=True)
        head, scans = lines[:8], lines[8:]
        for name, part in {"log": scans[:50], "first": scans[:30], "rest": scans[30:50], "late": scans[3:45]}.items():
            (self.inputs / f"{name}.clf").write_text("".join(head + part))
        (self.inputs / "log.clf.gz").write_bytes(gzip.compress((self.inputs / "log.clf").read_bytes(), mtime=0))
        for name, text in SETTINGS.items():
            (self.inputs / f"{name}.ini").write_text(text)
        (self.inputs / "zones.edits").write_text(EDITS)
        for words in (["first.clf", "-o", "old_grid", "--save-session", "first.session"], ["log.clf", "-o", "grid"]):
            self.run(self.inputs, words)

    def run(self, folder, words, **faults):
        """Runs psi-slam in a folder with faults of the preloaded library: those of failing_system.c, in small letters."""
        trace = folder.with_suffix(".trace")
        trace.unlink(missing_ok=True)
        environment = dict(os.environ, LD_PRELOAD=str(self.failing_system), PSI_FAULT_TRACE=str(trace), PSI_FAULT_FOLDER=str(folder))
        environment.update({f"PSI_FAULT_{name.upper()}": str(value) for name, value in faults.items()})
        start = time.monotonic()
        done = subprocess.run([self.program, *words], cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
        lines = trace.read_text().splitlines() if trace.exists() else []
        calls = [Call(int(line.split()[0]), *line.split()[1:3], line.endswith(" failed")) for line in lines]
        return Run(done.returncode, done.stderr.splitlines(), calls, time.monotonic() - start)

    def folder(self, name, content=None):
        """A new folder with copies of files."""
        folder = self.work / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for path, bytes_ in (content or {}).items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(bytes_)
        return folder

    def results(self, name, words, content=None):
        """Runs psi-slam without fault, unless these words ran before in an empty folder. Returns the run and the files after it."""
        if content is None and tuple(words) in self.known:
            return self.known[tuple(words)]
        folder = self.folder(name, content)
        run = self.run(folder, words)
        if run.code not in (0, 1 if words[0] == "diff" else 0):
            raise Fault(f"exit code {run.code} without fault: {run.err}")
        if content is None:
            self.known[tuple(words)] = run, files_in(folder)
        return run, files_in(folder)

    def submit(self, test, *words):
        self.tasks.append(self.pool.submit(test, *words))

    def expect(self, what, test, *words):
        """Runs one test, counts it and collects its failure."""
        self.counts[what] += 1
        try:
            test(*words)
        except (Fault, ValueError, subprocess.TimeoutExpired) as fault:
            self.failures.append(f"{what}, {' '.join(str(word) for word in words if isinstance(word, (int, str)))}: {fault}")
            print(self.failures[-1], file=sys.stderr, flush=True)

    def complaint(self, run, good):
        """The only sentence that a run without fault does not print, besides notices about the journal."""
        new = [line for line in run.err if line not in good.err and "psi-slam: the journal is" not in line]
        if len(new) != 1:
            raise Fault(f"exit code {run.code} and {len(new)} sentences: {new}")
        return new[0]

    def fail_write(self, name, number, kind, command, before, good, after):
        folder = self.folder(f"{name}-{kind}-{number}", before)
        run = self.run(folder, command.words, call=number, kind=kind)
        failed = [call for call in run.calls if call.failed]
        if not failed:  # the thread of the journal makes one call less or more in each run
            self.counts[f"{command.name}: runs that ended before the call"] += 1
            return self.run_again(folder, command, good, after)
        call = failed[0]
        is_removal = ".partial-" in call.path and call.name in ("remove", "unlink")  # of temporary files
        kinds = sort_out(folder, before, after, kind == "kill" or is_removal)
        results = {kinds[path] for path in kinds if path.startswith("out/")}
        if run.code != good.code:
            self.check_old_results(run, call, results)
        if kind == "kill":
            if run.code != -9:
                raise Fault(f"exit code {run.code} after a kill")
            if number % 5 == 1:
                self.run_again(folder, command, good, after)
        elif run.code == good.code:
            if not (is_removal or "j.journal" in call.path) or "old" in results:
                raise Fault(f"no failure, though {call.name} of {call.path} failed")
        elif run.code != (2 if command.name == "diff" else 1):
            raise Fault(f"exit code {run.code}: {run.err}")
        else:
            self.check_sentence(call, self.complaint(run, good), kind, folder)
        shutil.rmtree(folder)

    def check_old_results(self, run, call, results):
        """Raises Fault if there are new results although none was complete when a call for them failed."""
        is_of_results = "out" in Path(call.path).parts[:-1] or call.path == "out"
        moves = [other.number for other in run.calls if other.name == "rename" and re.match(r"(\./)?out/[^.][^/]*$", other.path)]
        if is_of_results and "new" in results and (not moves or moves[0] >= call.number):
            raise Fault(f"only some results are new, though {call.name} of {call.path} failed before the first was moved")

    def check_sentence(self, call, sentence, kind, folder):
        """Raises Fault unless a sentence names the reason and the file, by its final name."""
        parts = [part for part in call.path.split("/") if not re.fullmatch(r"\.partial-\d+-[0-9a-f]{16}", part)]
        place = PARTIAL.sub("", parts[-1]) if parts[-1] else parts[-2]
        if place in (folder.name, "j.journal"):  # entries of the current folder; journal: mapping goes on until other writes fail
            place = ""
        if REASONS[kind] not in sentence or place not in sentence or ".partial" in sentence:
            raise Fault(f"{call.name} of {call.path}: {sentence}")

    def run_again(self, folder, command, good, after):
        run = self.run(folder, command.words)
        if run.code != good.code or set(sort_out(folder, {}, after, True).values()) - {"same"} != {"new"}:
            raise Fault(f"the next run ends with {run.code}: {run.err}")

    def writes(self, command, old_command):
        _, before = self.results(f"{command.name}-before", old_command.words)
        if command.name in MAPPING:
            # With one thread, the calls come in the same order in each run, and the first one that fails ends the run.
            command = command._replace(words=[*command.words, "--set", "run.threads=1"])
            before = {**before, "out/trajectory-3.tum": b"1 0 0 0 0 0 0 1\n"}  # of older results with more logs
        good, after = self.results(f"{command.name}-after", command.words, before)
        counted = [call for call in good.calls if call.name != "read"]
        if not counted:
            raise Fault("the preloaded library sees no call that writes")
        for call in counted[::self.options.every]:
            kinds = ["enospc", "eio", "kill"] + (["short"] if "write" in call.name else [])
            for kind in kinds if self.options.every == 1 else [random.choice(kinds)]:
                what = f"{command.name}: {'kills before a write' if kind == 'kill' else 'failing writes, ' + kind}"
                self.submit(self.expect, what, self.fail_write, command.name, call.number, kind, command, before, good, after)

    def fail_read(self, name, end, cut, log, words, good, after):
        folder = self.folder(f"{name.replace('.', '-')}-read-{end}-{cut}")
        copy = self.folder(folder.name + "-input") / log.name
        shutil.copy(log, copy)
        faults = {"read": copy, "read_end": end, **({"read_cut": cut} if cut else {})}
        run = self.run(folder, [str(copy) if word == str(log) else word for word in words], **faults)
        if run.code == 0:
            if any("cannot be resumed from it" in line for line in run.err):
                (folder / "s.session").write_bytes(after["s.session"])
            kinds = sort_out(folder, {}, after, False)
            if set(kinds.values()) != {"new"} or kinds.keys() != after.keys():
                raise Fault("exit code 0 with other results")
            if not cut:
                raise Fault("exit code 0 after a read error")
            return
        sentences = [line for line in run.err if str(copy.name) in line and "cannot be resumed from it" not in line]
        if run.code != 2 or len(sentences) != 1 or (not cut and REASONS["eio"] not in sentences[0]):
            raise Fault(f"exit code {run.code}: {run.err}")
        shutil.rmtree(copy.parent)
        shutil.rmtree(folder)

    def reads(self):
        words = commands(self.inputs, "new")[0].words
        for log in (self.inputs / "log.clf", self.inputs / "log.clf.gz"):
            size = log.stat().st_size
            line = log.read_bytes().find(b"\n", size // 2) + 1 if log.suffix == ".clf" else size // 3
            _, after = self.results(f"read-after-{log.suffix[1:]}", [str(log), *words[1:]])
            good = self.run(self.folder(f"read-count-{log.suffix[1:]}"), [str(log), *words[1:]], read=log)
            reads = sum(call.name == "read" for call in good.calls)
            with_log = [str(log), *words[1:]]
            for end in sorted({0, 1, size // 2, line, size - 1} if self.options.every == 1 else {line}):
                self.submit(self.expect, "read errors", self.fail_read, log.name, end, 0, log, with_log, good, after)
            for cut in range(2, reads + 1, self.options.every):  # before the first read, the log is not yet known to be longer
                for end in (0, size // 2, line) if self.options.every == 1 else (line,):
                    self.submit(self.expect, "truncated logs", self.fail_read, log.name, end, cut, log, with_log, good, after)

    def set_clock_back(self, call, words, after):
        folder = self.folder(f"clock-{call}")
        run = self.run(folder, words, clock=call)
        kinds = sort_out(folder, {}, after, False)
        if run.code != 0 or set(kinds.values()) != {"new"} or kinds.keys() != after.keys():
            raise Fault(f"exit code {run.code}: {run.err}")

    def clocks(self):
        words = commands(self.inputs, "new")[0].words
        _, after = self.results("clock-after", words)
        for call in (1, 2, 5, 20)[::self.options.every]:
            self.submit(self.expect, "clock set back", self.set_clock_back, call, words, after)

    def kill_often(self, name, part, kills, versions):
        """Kills a command again and again in one folder, each time with other settings than the time before."""
        folder = self.folder(f"{name}-kills-{part}", versions[0][2])
        for kill in range(kills):
            command, good, after = versions[(kill + 1) % 2]
            before = {path: content for path, content in files_in(folder).items() if ".partial-" not in path}
            moment_s = random.uniform(0, 1.1 * good.duration_s)
            child = subprocess.Popen([self.program, *command.words], cwd=folder, stdout=subprocess.DEVNULL,
                                     stderr=subprocess.DEVNULL)
            try:
                child.wait(moment_s)
                self.counts[f"{name}: ended before the kill"] += 1
                if child.returncode != good.code:
                    self.failures.append(f"{name}: exit code {child.returncode} without a kill")
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
            self.expect(f"{name}: random kills", self.check_kill, folder, before, command, good, after, kill % 10 == 9)

    def check_kill(self, folder, before, command, good, after, runs_again):
        sort_out(folder, before, after, True)
        if not runs_again:
            return
        self.run_again(folder, command, good, after)
        for left in list(folder.rglob(".partial-*")):
            shutil.rmtree(left, ignore_errors=True) if left.is_dir() else left.unlink(missing_ok=True)

    def kills(self, pairs):
        """Divides the kills among the commands that map."""
        pairs = [(new, old) for new, old in pairs if new.name in MAPPING]
        versions = [[(command, *self.results(f"{command.name}-kills", command.words)) for command in (old, new)]
                    for new, old in pairs]
        for part in range(0, self.options.kills if pairs else 0, KILLS_IN_FOLDER):
            number = part // KILLS_IN_FOLDER % len(pairs)
            kills = min(KILLS_IN_FOLDER, self.options.kills - part)
            self.submit(self.kill_often, pairs[number][0].name, part, kills, versions[number])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--commands", nargs="+", default=["map", "resume", "merge", "localize", "diff"])
    parser.add_argument("--only", nargs="+", default=["writes", "reads", "clock", "kills"])
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    random.seed(1)
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        tests = Tests(options.build.resolve(), options.source.resolve(), Path(work), options, pool)
        if not tests.can_preload():
            print("faults_test.py: psi-slam does not run with a preloaded library")
            return 77
        tests.make_inputs()
        pairs = [(new, old) for new, old in zip(commands(tests.inputs, "new"), commands(tests.inputs, "old"))
                 if new.name in options.commands]
        if "kills" in options.only:
            tests.kills(pairs)
        if "writes" in options.only:
            for new, old in pairs:
                tests.submit(tests.writes, new, old)
        if "reads" in options.only:
            tests.submit(tests.reads)
        if "clock" in options.only:
            tests.submit(tests.clocks)
        try:
            for task in tests.tasks:  # tasks add others
                task.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    for what, count in sorted(tests.counts.items()):
        print(f"{what}: {count}")
    print(f"{len(tests.failures)} failures")
    return 1 if tests.failures else 0


if __name__ == "__main__":
    sys.exit(main())
