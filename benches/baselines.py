#!/usr/bin/env python3
"""Medians of the benches: kept as a table, and a new run against a table kept before.

    cargo bench -p texrender-rs --no-run
    RAYON_NUM_THREADS=1 taskset -c 1 chrt -f 20 cargo bench -p texrender-rs -- '^(sampler|mipmap)'
    benches/baselines.py export benches/baselines/NAME.csv
    benches/baselines.py compare benches/baselines/NAME.csv

`export` writes the medians that criterion left of its last runs, a line each: id, nanoseconds. `compare` prints the ids
that moved by more than --percent, the most slowed down first, and those that only one side has. --criterion is
criterion's folder, `criterion` in cargo's target folder. A run takes two minutes; compare on the kind of machine that the
table is of, with nothing else running.

baselines/epyc-zen4.csv: one of two shared cores of an AMD EPYC (Zen 4, AVX-512), as above, Rust 1.95, November 2026.
"""
import argparse
import csv
import json
import sys
from pathlib import Path


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=["export", "compare"])
    parser.add_argument("table", type=Path)
    parser.add_argument("--criterion", type=Path, default=Path("target/criterion"))
    parser.add_argument("--percent", type=float, default=15)
    return parser.parse_args()


def last_medians(folder):
    """Nanoseconds by id."""
    found = {}
    for estimates in folder.glob("**/new/estimates.json"):
        name = json.loads(estimates.with_name("benchmark.json").read_text())["full_id"]
        found[name] = json.loads(estimates.read_text())["median"]["point_estimate"]
    if not found:
        sys.exit(f"{folder} holds no runs: run `cargo bench` first, or name the folder with --criterion")
    return found


def export(medians, table):
    table.parent.mkdir(parents=True, exist_ok=True)
    with table.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["id", "median ns"])
        rows.writerows((name, f"{medians[name]:.4g}") for name in sorted(medians))
    print(f"{len(medians)} medians in {table}")


def compare(medians, table, percent):
    with table.open(newline="") as file:
        kept = {name: float(median) for name, median in list(csv.reader(file))[1:]}
    both = kept.keys() & medians.keys()
    changes = {name: 100 * (medians[name] / kept[name] - 1) for name in both}
    moved = [name for name in both if abs(changes[name]) > percent]
    for name in sorted(moved, key=lambda name: (-changes[name], name)):
        print(f"{changes[name]:+7.1f} %  {kept[name]:>12.4g} ns  {medians[name]:>12.4g} ns  {name}")
    for side, names in [("only in the table", kept.keys() - both), ("not in the table", medians.keys() - both)]:
        if names:
            print(f"{side}: {', '.join(sorted(names))}")
    print(f"{len(moved)} of {len(both)} moved by more than {percent:g} %")


def main():
    args = arguments()
    medians = last_medians(args.criterion)
    if args.action == "export":
        export(medians, args.table)
    else:
        compare(medians, args.table, args.percent)


if __name__ == "__main__":
    main()
