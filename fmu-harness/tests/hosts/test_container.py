"""fmucontainer, a host compiled from C: two of our instances inside one FMU equal two alone."""

import shutil
import subprocess
import sys
from pathlib import Path

from fmpy import simulate_fmu

STEP, STOP = 1e-4, 0.012
WEAR = {"first": 5e-4, "second": 2e-4}


def contained(mechanism, folder):
    """Packs two copies of an FMU, which differ in the clearance of a joint."""
    rules = ["rule;from_fmu;from_port;to_fmu;to_port"]
    for name, clearance in WEAR.items():
        shutil.copy(mechanism.file, folder / f"{name}.fmu")
        rules.append(f"FMU;{name}.fmu;;;")
        rules.append(f"START;{name}.fmu;joint.C.clearance;{clearance};")
        for variable in mechanism.description.modelVariables:
            if variable.causality == "input":
                rules.append(f"INPUT;;{name}.{variable.name};{name}.fmu;{variable.name}")
            elif variable.causality == "output":
                rules.append(f"OUTPUT;{name}.fmu;{variable.name};;{name}.{variable.name}")
    table = folder / "pair.csv"
    table.write_text("\n".join(rules) + "\n")
    command = [Path(sys.executable).with_name("fmucontainer"), "-container", f"{table.name}:{STEP}"]
    command += ["-fmu-directory", folder, "-no-auto-input", "-no-auto-output", "-no-auto-link"]
    done = subprocess.run(
        list(map(str, command)), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert done.returncode == 0 and "ERROR" not in done.stdout and "WARNING" not in done.stdout, done.stdout
    return folder / "pair.fmu"


def test_two_in_a_container_equal_two_alone(wornpin, tmp_path):
    pair = contained(wornpin, tmp_path)
    outputs = [variable.name for variable in wornpin.outputs()]
    names = [f"{name}.{output}" for name in WEAR for output in outputs]
    # The container's own description breaks rules, as FMPy's validator says; the units in it do not.
    together = simulate_fmu(str(pair), validate=False, stop_time=STOP, output_interval=STEP, output=names)
    assert len(together) == round(STOP / STEP) + 1
    for name, clearance in WEAR.items():
        slave = wornpin.start({"joint.C.clearance": clearance})
        for point, row in enumerate(together[1:]):
            # So the container calls: whole multiples of its step, and the step itself.
            slave.fmu.doStep(point * STEP, STEP)
            assert slave.get_all(outputs) == [row[f"{name}.{output}"] for output in outputs], point
        slave.free()
