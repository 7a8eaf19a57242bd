"""What FMPy's CVode makes of a unit in model exchange, and what it costs.

    python exchange.py JOB.json

The job: `fmu`, a file; `settings`, names and values set before initialisation; `inputs`, constant ones by name; `tolerances`;
`window` [s]; `step` [s], the interval of outputs; `kept`, outputs that go into FOLDER/N.csv for the Nth tolerance.

Prints a list with an entry for each tolerance: `cost`, CPU time of this process per simulated second; or `failed`, the
reason.
"""

import json
import sys
import time
from pathlib import Path

from fmpy import extract, read_model_description, simulate_fmu


def measured(job, folder, description, number, tolerance):
    begin = time.process_time()
    # CVode as FMPy sets it up makes no more than 500 steps between two outputs: long intervals fail.
    result = simulate_fmu(
        folder,
        fmi_type="ModelExchange",
        model_description=description,
        stop_time=job["window"],
        relative_tolerance=tolerance,
        output_interval=job["step"],
        output=job["kept"],
        start_values={**job["settings"], **job["inputs"]},
        record_events=False,
    )
    cost = (time.process_time() - begin) / job["window"]
    columns = ["time", *job["kept"]]
    with open(Path(job["folder"]) / f"{number}.csv", "w") as out:
        out.write(",".join(columns) + "\n")
        for row in zip(*(result[column] for column in columns)):
            out.write(",".join(repr(float(value)) for value in row) + "\n")
    return {"cost": cost}


def main(file):
    job = json.loads(Path(file).read_text())
    folder = extract(job["fmu"], unzipdir=str(Path(job["folder"]) / "unit"))
    description = read_model_description(folder)
    results = []
    for number, tolerance in enumerate(job["tolerances"]):
        try:
            results.append(measured(job, folder, description, number, tolerance))
        except Exception as error:  # whatever FMPy says, a run that fails is drawn
            results.append({"failed": str(error)})
    print(json.dumps(results))


if __name__ == "__main__":
    main(sys.argv[1])
