#!/usr/bin/env python3
"""texrender beside other software rasterisers, in turn, in one run.

    cargo build --release -p texrender-rs
    benches/peers.py --peers ../shared/peers/gl --cache /tmp/peers

PEERS is a folder with the scenes' description and the other programs' bench: its `run.sh` installs and times them
and writes their pictures under CACHE/gl, its `truth.py` measures every picture's error against the same reference and
knows none of the programs. For each scene, filter and number of threads the programs take turns, ROUNDS times, the
order reversed from round to round; the median over all rounds' medians counts. Prints Markdown, and the rows as CSV
with --csv FILE.
"""
import argparse
import csv
import os
import statistics
import subprocess
import sys

FILTERS = ["nearest", "bilinear", "bilinear_mip", "trilinear", "aniso2", "aniso4", "aniso8", "aniso16"]
SCENES = ["fill_mag", "fill_min4", "fill_min3", "spheres", "heightfield", "overdraw_b2f", "overdraw_f2b", "normalmapped"]
PEERS = ["llvmpipe-25.0", "lavapipe-25.0", "swiftshader"]
SELF = "texrender"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peers", required=True, help="folder of run.sh, truth.py and scenes.md")
    parser.add_argument("--cache", required=True, help="folder for what run.sh installs and writes")
    parser.add_argument("--texrender", default="target/release/texrender", help="the program to time")
    parser.add_argument("--scenes", default=",".join(["plane", *SCENES]))
    parser.add_argument("--filters", default=",".join(FILTERS), help="of the plane")
    parser.add_argument("--textures", default="natural", help="of the plane: checker, zone, natural")
    parser.add_argument("--programs", default=",".join(PEERS))
    parser.add_argument("--threads", default="2,1")
    parser.add_argument("--frames", type=int, default=21)
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--csv", help="file for the rows")
    return parser.parse_args()


def run_peer(args, peer, scene, wanted, threads):
    """Rows of one peer: (filter, texture) -> ms."""
    env = dict(os.environ, PEERS_DIR=args.cache)
    if wanted:
        env.update(BENCH_FILTER=wanted[0], BENCH_TEX=wanted[1])
    command = ["./run.sh", "-s", scene, "-p", peer, "-t", threads, "-r", "1", "-n", str(args.frames), "-I", "-E"]
    done = subprocess.run(command, cwd=args.peers, env=env, capture_output=True, text=True, check=True)
    rows = (row for row in csv.reader(done.stderr.splitlines()) if len(row) == 10 and row[0] == peer)
    return {(row[3], row[4]): float(row[5]) for row in rows}


def run_self(args, scene, wanted, threads, dump):
    """Our rows, as run_peer's."""
    command = [os.path.abspath(args.texrender), "bench", "--scene", scene, "--threads", threads, "--csv"]
    command += ["--frames", str(args.frames), "--textures", os.path.join(args.cache, "gl", "tex")]
    if wanted:
        command += ["--filter", wanted[0], "--texture", wanted[1], "--dump", dump]
    if threads == "1":
        command = ["taskset", "-c", "1", *command]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    rows = csv.DictReader(done.stdout.splitlines())
    return {(row["filter"], row["texture"]): float(row["ms_median"]) for row in rows}


def measure(args, dump):
    """(scene, filter, texture, threads) -> program -> medians."""
    times = {}
    for scene in args.scenes.split(","):
        kinds = [None]
        if scene == "plane":
            kinds = [(f, t) for t in args.textures.split(",") for f in args.filters.split(",")]
        for wanted in kinds:
            for threads in args.threads.split(","):
                for round_ in range(args.rounds):
                    programs = [*args.programs.split(","), SELF]
                    for program in programs if round_ % 2 == 0 else reversed(programs):
                        if program == SELF:
                            rows = run_self(args, scene, wanted, threads, dump)
                        else:
                            rows = run_peer(args, program, scene, wanted, threads)
                        for key, ms in rows.items():
                            times.setdefault((scene, *key, threads), {}).setdefault(program, []).append(ms)
                print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return {key: {p: statistics.median(ms) for p, ms in of.items()} for key, of in times.items()}


def errors(args, dump):
    """(program, filter, texture) -> RMSE of the plane's pictures, all by the peers' own tool."""
    base = os.path.join(args.cache, "gl")
    python = os.path.join(base, "venv", "bin", "python")
    truth, tool = os.path.join(base, "truth.npz"), os.path.join(args.peers, "truth.py")
    textures = os.path.join(base, "tex")
    if not os.path.exists(truth):
        subprocess.run([python, tool, "truth", textures, truth], check=True, stdout=sys.stderr)
    found = {}
    for folder in [os.path.join(base, "img"), dump]:
        out = os.path.join(base, "errors-side-by-side.csv")
        subprocess.run([python, tool, "errors", textures, truth, folder, out], check=True, stdout=subprocess.DEVNULL)
        with open(out, newline="") as rows:
            found.update({(r["peer"], r["filter"], r["texture"]): float(r["rmse"]) for r in csv.DictReader(rows)})
    return found


def main():
    args = arguments()
    dump = os.path.join(args.cache, "gl", "img-texrender")
    os.makedirs(dump, exist_ok=True)
    times = measure(args, dump)
    rmse = errors(args, dump) if "plane" in args.scenes.split(",") else {}
    rows = []
    print("| scene | threads | texrender, ms | RMSE | fastest other, ms | RMSE | ratio |")
    print("|---|---|---|---|---|---|---|")
    for (scene, filter_, texture, threads), of in times.items():
        for program, ms in of.items():
            error = rmse.get((program, filter_, texture), "") if scene == "plane" else ""
            rows.append([program, scene, filter_, texture, threads, f"{ms:.2f}", error])
        others = {p: ms for p, ms in of.items() if p != SELF}
        if SELF not in of or not others:
            continue
        best = min(others, key=others.get)
        shown = [rmse.get((p, filter_, texture), "") if scene == "plane" else "" for p in (SELF, best)]
        name = f"{scene}, {filter_}" + (f", {texture}" if scene == "plane" else "")
        print(
            f"| {name} | {threads} | {of[SELF]:.2f} | {shown[0]} | {others[best]:.2f} ({best}) | {shown[1]} "
            f"| {others[best] / of[SELF]:.2f} |"
        )
    if args.csv:
        with open(args.csv, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["program", "scene", "filter", "texture", "threads", "ms_median", "rmse"])
            writer.writerows(rows)


if __name__ == "__main__":
    main()
