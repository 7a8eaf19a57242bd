"""The press, its speed controller and the sheet, wired once for every host.

    coupling.py ecos FOLDER STEP POINTS

runs the loop in ecos, in a process of its own, and prints a row for each communication point.
"""

import sys
import zipfile
from pathlib import Path

UNITS = {"press": "press.fmu", "controller": "SpeedController.fmu", "sheet": "Sheet.fmu"}
WIRES = [
    ("press", "crank.speed", "controller", "speed"),
    ("press", "crank.angle", "sheet", "angle"),
    ("controller", "torque", "press", "crank.torque"),
    ("sheet", "force", "press", "slider.load"),
]
# What goes over the wires, as those who get it see it; and what the press makes of it.
WATCHED = ["crank.speed", "slider.x", "slider.v"]
SIGNALS = [f"{unit}.{end}" for _, _, unit, end in WIRES] + [f"press.{end}" for end in WATCHED]


def units(folder, press):
    """Puts the three FMUs into a folder."""
    from shutil import copy

    from pythonfmu.builder import FmuBuilder

    here = Path(__file__).parent
    for source in ("controller.py", "sheet.py"):
        FmuBuilder.build_FMU(here / source, dest=folder)
    copy(press, folder / UNITS["press"])


def system_structure(folder):
    """The same units and wires as an SSP 1.0 package."""
    parts = ""
    for name, file in UNITS.items():
        ends = [(wire[1], "output") for wire in WIRES if wire[0] == name]
        ends += [(end, "output") for end in WATCHED if name == "press" and (end, "output") not in ends]
        ends += [(wire[3], "input") for wire in WIRES if wire[2] == name]
        connectors = "".join(
            f'<ssd:Connector name="{end}" kind="{kind}"><ssc:Real/></ssd:Connector>' for end, kind in ends
        )
        parts += (
            f'<ssd:Component name="{name}" type="application/x-fmu-sharedlibrary" source="resources/{file}">'
            f"<ssd:Connectors>{connectors}</ssd:Connectors></ssd:Component>"
        )
    wires = "".join(
        f'<ssd:Connection startElement="{a}" startConnector="{b}" endElement="{c}" endConnector="{d}"/>'
        for a, b, c, d in WIRES
    )
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<ssd:SystemStructureDescription name="press" version="1.0"'
        ' xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription"'
        ' xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon">'
        f'<ssd:System name="press"><ssd:Elements>{parts}</ssd:Elements>'
        f"<ssd:Connections>{wires}</ssd:Connections></ssd:System></ssd:SystemStructureDescription>"
    )
    package = folder / "press.ssp"
    with zipfile.ZipFile(package, "w") as archive:
        archive.writestr("SystemStructure.ssd", text)
        for file in UNITS.values():
            archive.write(folder / file, f"resources/{file}")
    return package


def ecos(folder, step, points):
    from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

    EcosLib.set_log_level("warn")
    with EcosSimulationStructure() as structure:
        for name, file in UNITS.items():
            structure.add_model(name, folder / file)
        for a, b, c, d in WIRES:
            structure.make_real_connection(f"{a}::{b}", f"{c}::{d}")
        with EcosSimulation(structure=structure, step_size=step) as simulation:
            simulation.init()
            for _ in range(points):
                time = simulation.step()
                names = [signal.replace(".", "::", 1) for signal in SIGNALS]
                print(time, *map(simulation.get_real, names))
            simulation.terminate()


if __name__ == "__main__":
    _, host, folder, step, points = sys.argv
    assert host == "ecos"
    ecos(Path(folder), float(step), int(points))
