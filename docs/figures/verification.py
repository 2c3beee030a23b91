#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/figures/verification.svg: six runs of dem_batch beside their exact answers, and fails if one is off.
`verification.py DEM_BATCH INPUTS PICTURE`."""
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import matplotlib
import numpy

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "dem", "svg.fonttype": "none", "font.size": 9, "axes.grid": True,
                            "grid.alpha": 0.3, "lines.markersize": 4})
from matplotlib import pyplot  # noqa: E402  (after the choice of its back end)

DEM_BATCH, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
G = 9.81
FLOOR = "&obstacle points = -9, 0, 9, 0, {law} /\n"


def write_lattice(path, x, springs=(), **more):
    """Nodes of 1 kg, and springs (i, j, rest length, stiffness), as a lattice file."""
    with h5py.File(path, "w") as file:
        group = file.create_group("lattice")
        group["x"], group["mass"] = numpy.array(x, float), numpy.ones(len(x))
        if springs:
            group["ends"] = numpy.array([s[:2] for s in springs])
            group["rest_length"] = numpy.array([s[2] for s in springs], float)
            group["stiffness"] = numpy.array([s[3] for s in springs], float)
        for name, values in more.items():
            group[name] = numpy.array(values, float)


def run(folder, deck, *settings):
    """Runs a deck's text, or a file of inputs/, and gives its frames' times and positions, its history and its results."""
    path = INPUTS / deck
    if "&" in deck:
        path = folder / "run.nml"
        path.write_text(deck, encoding="utf-8")
    name = "run" if "&" in deck else path.stem
    options = [word for setting in settings for word in ("--set", setting)]
    done = subprocess.run([DEM_BATCH, "--overwrite", *options, "--outdir", folder, path], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    with h5py.File(folder / f"{name}.vtkhdf") as file:
        history = {key: file["history"][key][...] for key in file["history"]}
        t = file["VTKHDF/Steps/Values"][...]
        x = file["VTKHDF/Points"][...].reshape(len(t), -1, 3)
    return t, x, history, json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


def expect(what, error, most):
    print(f"{what}: off by {error:.1e}, at most {most:.0e}")
    if not error < most:
        sys.exit(f"{what}: {error:.3e} is not below {most:.0e}")


def bounce(axes, folder):
    """A ball of restitution 0.8 dropped from 1 m: parabolas, each impact leaving 0.8 of the speed."""
    eta, end = 0.8, 2.4
    write_lattice(folder / "ball.h5", [[0, 1]])
    t, x, *_ = run(folder, f"&run t_end = {end} / &solver spacing = 1, max_step = 1e-2, rtol = 1e-10 /\n"
                   "&body shape = 'file', file = 'ball.h5' /" + FLOOR.format(law=f"restitution = {eta}") +
                   "&output name = 'run', frame_interval = 2e-2 /")

    def height(now):
        start, speed, y = 0.0, 0.0, 1.0
        while True:
            flight = (speed + (speed**2 + 2 * G * y) ** 0.5) / G
            if now < start + flight:
                return y + speed * (now - start) - G * (now - start) ** 2 / 2
            start, speed, y = start + flight, eta * (flight * G - speed), 0.0

    fine = numpy.linspace(0, end, 1000)
    axes.plot(fine, [height(now) for now in fine], "k-", lw=0.8, label="exact")
    axes.plot(t, x[:, 0, 1], ".", label="dem")
    axes.set(title="a ball of restitution 0.8", xlabel="t, s", ylabel="height, m")
    expect("bounce", numpy.abs(x[:, 0, 1] - [height(now) for now in t]).max(), 1e-5)  # the penetration tolerance is 1e-6 m deep, four times


def incline(axes, folder):
    """A point thrown up an incline of 30 degrees at 3 m/s, for three frictions: it turns back, or it stays."""
    angle, end = numpy.radians(30), 1.2
    along, up = numpy.array([numpy.cos(angle), numpy.sin(angle)]), G * numpy.sin(angle)
    worst = 0.0
    for mu, colour in ((0.0, "C0"), (0.3, "C1"), (0.8, "C2")):
        write_lattice(folder / "point.h5", [[0, 0]], velocity=[3 * along])
        drag = mu * G * numpy.cos(angle)
        t, x, *_ = run(folder, f"&run t_end = {end} / &solver spacing = 1, max_step = 1e-2, rtol = 1e-10 /\n"
                       "&body shape = 'file', file = 'point.h5' /"
                       f"&obstacle points = {-9 * along[0]}, {-9 * along[1]}, {9 * along[0]}, {9 * along[1]}, restitution = 0,"
                       f" friction = {mu} /\n"
                       "&output name = 'run', frame_interval = 4e-2 /")
        stop = 3 / (up + drag)
        top, back = 3 * stop / 2, max(up - drag, 0.0)

        def way(now, stop=stop, top=top, back=back, drag=drag):
            return numpy.where(now < stop, 3 * now - (up + drag) * now**2 / 2, top - back * (now - stop) ** 2 / 2)

        fine = numpy.linspace(0, end, 500)
        axes.plot(fine, way(fine), "k-", lw=0.8)
        axes.plot(t, x[:, 0, :2] @ along, ".", color=colour, label=f"mu = {mu:g}")
        worst = max(worst, numpy.abs(x[:, 0, :2] @ along - way(t)).max())
    axes.set(title="a point thrown up an incline of 30 degrees", xlabel="t, s", ylabel="way, m")
    expect("incline", worst, 1e-8)  # rtol in each of a hundred steps; along the incline the penetration tolerance does not count


def pair(axes, errors, folder):
    """Two masses of 1 kg on a spring of 1 m, pulled out by 30 %: a cosine, the law being linear in the distance."""
    stiffness, end = 100.0, 2.0
    omega = (2 * stiffness) ** 0.5
    found = []
    for digits in range(4, 11):
        write_lattice(folder / "pair.h5", [[0, 0], [1, 0]], [(0, 1, 1, stiffness)], position=[[-0.15, 0], [1.15, 0]])
        t, x, *_ = run(folder, f"&run t_end = {end}, gravity = 0, 0 / &solver rtol = 1e-{digits} /\n"
                       "&body shape = 'file', file = 'pair.h5' /"
                       "&output name = 'run', frame_interval = 2e-2 /")
        distance = x[:, 1, 0] - x[:, 0, 0]
        found.append(numpy.abs(distance - 1 - 0.3 * numpy.cos(omega * t)).max())
    fine = numpy.linspace(0, end, 1000)
    axes.plot(fine, 1 + 0.3 * numpy.cos(omega * fine), "k-", lw=0.8, label="exact")
    axes.plot(t, distance, ".", label="dem")
    axes.set(title="two masses on a spring", xlabel="t, s", ylabel="distance, m")
    rtol = 10.0 ** -numpy.arange(4, 11)
    errors.loglog(rtol, rtol, "k-", lw=0.8, label="error = rtol")
    errors.loglog(rtol, found, "o", label="dem")
    errors.set(title="the same: largest error of the distance", xlabel="rtol", ylabel="error, m")
    expect("pair at rtol 1e-10", found[-1], 1e-9)  # the errors of a step add up, over 4.5 periods


def bar(axes, folder):
    """Bars of 8 mm and of several lengths strike a wall endwise at 0.1 m/s: the wave is back after 2 L/c."""
    young, density, lengths = 1e7, 1050.0, numpy.array([0.08, 0.12, 0.16, 0.24])
    found = []
    for length in lengths:
        *_, result = run(folder, "&run t_end = 8e-3, gravity = 0, 0 /"
                         f"&material youngs_modulus = {young}, density = {density} /"
                         f"&body shape = 'rectangle', size = 8e-3, {length}, spacing = 2e-3, velocity = 0, -0.1, position = 0, 1e-6 /"
                         + FLOOR.format(law="restitution = 0") + "&output name = 'run', frame_interval = 8e-3 /")
        found.append(result["last_contact"] - result["first_contact"])
    exact = 2 * lengths / (young / density) ** 0.5
    axes.plot(1e3 * lengths, 1e3 * exact, "k-", lw=0.8, label="2 L/c")
    axes.plot(1e3 * lengths, 1e3 * numpy.array(found), "o", label="dem")
    axes.set(title="contact time of a bar", xlabel="length L, mm", ylabel="ms")
    expect("bar", numpy.abs(numpy.array(found) / exact - 1).max(), 0.03)  # the body is 4 spacings wide, and the last node leaves late; found 0.01


def closure(axes, folder):
    """What the ledger of energies of the paper's bodies gains, over the largest energy, at 5 mm."""
    for name in ("rectangle", "disc", "porous"):
        rtol = 10.0 ** -numpy.arange(5, 10)
        found = [numpy.abs(run(folder, f"{name}.nml", "body.spacing=5e-3", "run.t_end=8e-3", f"solver.rtol={r:g}")[2]["closure"]).max()
                 for r in rtol]
        axes.loglog(rtol, found, "o-", lw=0.8, label=name)
        expect(f"closure of {name} at 1e-9", found[-1], 1e-6)  # 2e-3 at 1e-6, as tests have it, falls at least as rtol
    axes.set(title="error of the energy ledger", xlabel="rtol", ylabel="share of the largest energy")


def main():
    figure, axes = pyplot.subplots(2, 3, figsize=(11, 6.2), layout="constrained")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bounce(axes[0, 0], folder)
        incline(axes[0, 1], folder)
        pair(axes[0, 2], axes[1, 2], folder)
        bar(axes[1, 0], folder)
        closure(axes[1, 1], folder)
    for each in axes.flat:
        each.legend(fontsize=8, framealpha=0.9)
    figure.savefig(sys.argv[3], metadata={"Date": None})


if __name__ == "__main__":
    main()
