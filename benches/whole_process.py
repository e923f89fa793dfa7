#!/usr/bin/env python3
"""From a glTF file to a PNG on disk, texrender and other renderers in turn: wall and CPU seconds, peak memory.

    cargo build --release -p texrender-rs --examples --bins
    cargo run --release -p texrender-rs --example showcase -- /tmp/heavy.glb heavy
    benches/whole_process.py --peers ../shared/peers/gltf --cache /tmp/peers --env ENV.hdr MODEL...

PEERS is a folder whose `peer.sh` installs and runs the others, from the camera that its `bounds.py` finds for a model;
texrender is given the same. 1920×1080, 4 samples where a program has them. The medians of --runs runs count. With
--frames N also the median of so many steady frames of a turntable.
"""
import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys

PEERS = ["filly", "f3d"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+")
    parser.add_argument("--peers", required=True)
    parser.add_argument("--cache", required=True)
    parser.add_argument("--env", required=True)
    parser.add_argument("--programs", default=",".join(PEERS))
    parser.add_argument("--target", default="target/release")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=0)
    return parser.parse_args()


def of_peer(args, peer, model, picture, frames):
    env = dict(os.environ, PEERS_DIR=args.cache)
    command = ["./peer.sh", peer, model, picture, "1920", "1080", args.env, str(frames)]
    done = subprocess.run(command, cwd=args.peers, env=env, capture_output=True, text=True)
    if done.returncode:
        return None
    found = json.loads(done.stdout.splitlines()[0])
    steady = re.search(r"median_frame_ms ([0-9.]+)", done.stdout)
    found["frame"] = float(steady.group(1)) if steady else None
    return found if found["rc"] == 0 else None


def of_texrender(args, model, picture, frames):
    sys.path.insert(0, args.peers)
    from bounds import bounds

    centre, radius = bounds(model)
    eye = [centre[0], centre[1], centre[2] + radius / math.sin(math.pi / 12)]
    view = [",".join(map(str, at)) for at in (eye, centre)]
    program = os.path.join(os.path.abspath(args.target), "texrender")
    command = [sys.executable, os.path.join(args.peers, "measure.py"), program, "render", model, "-o", picture]
    command += ["--size", "1920x1080", "--fov", "30", "--env", args.env]
    # An argument that begins with a minus sign would be read as an option.
    command += [f"--eye={view[0]}", f"--target={view[1]}"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout.splitlines()[0])
    if found["rc"]:
        sys.exit(f"texrender failed on {model}")
    if frames:
        turntable = os.path.join(os.path.abspath(args.target), "examples", "turntable")
        done = subprocess.run([turntable, model, str(frames), args.env], capture_output=True, text=True, check=True)
        found["frame"] = float(done.stdout.split()[1])
    return found


def main():
    args = arguments()
    args.env, args.peers = os.path.abspath(args.env), os.path.abspath(args.peers)
    print("| model | program | wall, s | CPU, s | peak memory, MB | steady frame, ms |")
    print("|---|---|---|---|---|---|")
    for model in map(os.path.abspath, args.models):
        found = {}
        for run in range(args.runs):
            frames = args.frames if run == 0 else 0
            for program in ["texrender", *args.programs.split(",")]:
                picture = os.path.join(args.cache, f"{program}-{os.path.basename(model)}.png")
                if program == "texrender":
                    result = of_texrender(args, model, picture, frames)
                else:
                    result = of_peer(args, program, model, picture, frames)
                if result:
                    found.setdefault(program, []).append(result)
        for program, runs in found.items():
            # The run that also draws steady frames has other wall times.
            plain = runs[1:] if args.frames and len(runs) > 1 and program != "texrender" else runs
            wall, cpu, memory = (statistics.median(r[k] for r in plain) for k in ("wall", "cpu", "maxrss_mb"))
            frame = next((r["frame"] for r in runs if r.get("frame")), "")
            print(f"| {os.path.basename(model)} | {program} | {wall:.2f} | {cpu:.2f} | {memory:.0f} | {frame} |", flush=True)


if __name__ == "__main__":
    main()
