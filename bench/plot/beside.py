#!/usr/bin/env python3
"""bench/plot/beside.py: pictures of equal height side by side.

    beside.py ONE.png OTHER.png ... -o OUT.png
"""

import argparse

import numpy
from plot import plt


def main():
    parser = argparse.ArgumentParser(description="pictures of equal height side by side")
    parser.add_argument("files", nargs="+", help="PNG")
    parser.add_argument("-o", "--output", required=True, help="OUT.png")
    options = parser.parse_args()
    pictures = [plt.imread(name)[:, :, :3] for name in options.files]
    gap = numpy.ones((pictures[0].shape[0], 8, 3), dtype=pictures[0].dtype)
    plt.imsave(options.output, numpy.hstack([part for picture in pictures for part in (gap, picture)][1:]))


if __name__ == "__main__":
    main()
