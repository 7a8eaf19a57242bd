"""The worn slider pin in Exudyn: crank and rod as one kinematic tree, the slider as another, and between them the
contact of a sphere in a hollow sphere, which in the plane is a journal in its bearing.

The crank has so large an inertia that it keeps its speed. Hunt and Crossley's damping, F = K d^n (1 + 3/2 (1 - e) d'/v),
is that of Lankarani and Nikravesh at another restitution e, the one that is set here; friction is proportional to the
sliding speed below v1. So its equations are the scene's, but that nothing limits d'/v. The speed v of a touch is that
at the end of the step in which the touch is noticed.
"""

import math

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np

import job as jobs

FLYWHEEL = 1e6  # [kg m2] Its speed changes by less than a millionth; a larger one upsets Newton's iteration.
FLAT = 1e-3  # [kg m2] Inertia about axes about which nothing turns.
# [N] A step is repeated, shorter, when the contact's change in it makes a larger error in force: touches are located so.
FORCE = 100.0
NEWTON = 1e-6  # Of the residual, which the flywheel's own makes large.
SHORTEST = 1e-12  # [s]
SOLVERS = {
    "generalized-alpha": exu.DynamicSolverType.GeneralizedAlpha,
    "RK44": exu.DynamicSolverType.RK44,
}


def restitution(parameters):
    """The one at which Hunt and Crossley's damping is that of the scene."""
    chi = 0.75 * (1 - parameters["joint.C.restitution"] ** 2)
    return 1 - chi / 1.5


def stiffness(a):
    bearing, c = a["joint.C.radius"], a["joint.C.clearance"]
    compliance = sum(
        (1 - a[f"joint.C.poisson.{part}"] ** 2) / a[f"joint.C.young.{part}"] for part in ("bearing", "journal")
    )
    return a["joint.C.stiffness"] or 4 / (3 * compliance) * math.sqrt(bearing * (bearing - c) / c)


def tree(mbs, coordinates, rates, joints, parents, offsets, inertias, centres, masses):
    node = mbs.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0] * len(coordinates),
            initialCoordinates=coordinates,
            initialCoordinates_t=rates,
            numberOfODE2Coordinates=len(coordinates),
        )
    )
    unit = [np.eye(3) for _ in masses]
    body = mbs.AddObject(
        items.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=joints,
            linkParents=parents,
            jointTransformations=exu.Matrix3DList(unit),
            jointOffsets=exu.Vector3DList(offsets),
            linkInertiasCOM=exu.Matrix3DList([np.diag([FLAT, FLAT, inertia]) for inertia in inertias]),
            linkCOMs=exu.Vector3DList(centres),
            linkMasses=masses,
        )
    )
    return node, body


def build(job):
    a = job["parameters"]
    x, theta, vx, omega = job["start"]
    start, speed = a["crank.angle_start"], a["crank.speed_start"]
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    turn, slide = exu.JointType.RevoluteZ, exu.JointType.PrismaticX
    arm, arm_body = tree(
        mbs, [start, theta - start], [speed, omega - speed], [turn, turn], [-1, 0], [[0, 0, 0], [a["crank.length"], 0, 0]],
        [FLYWHEEL, a["rod.inertia"]], [[0, 0, 0], [a["rod.com.x"], 0, 0]], [a["crank.mass"], a["rod.mass"]],
    )  # fmt: skip
    rail, rail_body = tree(
        mbs, [x], [vx], [slide], [-1], [[0, a["guide.offset"], 0]], [FLAT], [[0, 0, 0]], [a["slider.mass"]],
    )  # fmt: skip
    journal = mbs.AddMarker(
        items.MarkerKinematicTreeRigid(objectNumber=rail_body, linkNumber=0, localPosition=[0, 0, 0])
    )
    bearing = mbs.AddMarker(
        items.MarkerKinematicTreeRigid(objectNumber=arm_body, linkNumber=1, localPosition=[a["rod.length"], 0, 0])
    )
    memory = mbs.AddNode(items.NodeGenericData(initialCoordinates=[1, 0, 0, 0], numberOfDataCoordinates=4))
    mbs.AddObject(
        items.ObjectContactSphereSphere(
            markerNumbers=[journal, bearing],
            nodeNumber=memory,
            spheresRadii=[a["joint.C.radius"] - a["joint.C.clearance"], a["joint.C.radius"]],
            isHollowSphere1=True,
            dynamicFriction=a["joint.C.friction.coefficient"],
            frictionProportionalZone=a["joint.C.friction.v1"],
            contactStiffness=stiffness(a),
            contactStiffnessExponent=a["joint.C.exponent"],
            restitutionCoefficient=restitution(a),
            minimumImpactVelocity=a["joint.C.speed_floor"],
            impactModel=1,
        )
    )
    sensors = [
        mbs.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))
        for kind in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        for node in (arm, rail)
    ]
    mbs.Assemble()
    return mbs, sensors, container


def march(job, method, step, points):
    span = job["span"]
    mbs, sensors, _container = build(job)
    settings = exu.SimulationSettings()
    integration, output = settings.timeIntegration, settings.solution
    integration.endTime = span
    integration.verboseMode = 0
    integration.verboseModeFile = 0
    output.file.write = False
    output.sensors.writePeriod = 1e-12 if points > 1 else 2 * span
    output.sensors.append = False
    integration.automaticStepSize = False
    integration.numberOfSteps = round(span / step)
    integration.minimumStepSize = SHORTEST
    # The implicit solver does not get past a touch that it locates so.
    integration.discontinuous.iterationTolerance = FORCE if method == "RK44" else math.inf
    integration.newton.relativeTolerance = NEWTON
    integration.newton.useModifiedNewton = True
    if not mbs.SolveDynamic(settings, solverType=SOLVERS[method], showHints=False, showCausingItems=False):
        raise RuntimeError("the solver failed")
    if points == 1:
        return [], 0, 0
    q_arm, q_rail, v_arm, v_rail = (np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors)
    times = q_arm[:, 0]
    values = np.column_stack([q_rail[:, 1], q_arm[:, 1] + q_arm[:, 2]])
    slopes = np.column_stack([v_rail[:, 1], v_arm[:, 1] + v_arm[:, 2]])
    found = hermite(times, values, slopes, np.linspace(span / points, span, points))
    return found, len(times) - 1, 0


def hermite(times, values, slopes, instants):
    """Cubic interpolation between steps."""
    i = np.clip(np.searchsorted(times, instants) - 1, 0, len(times) - 2)
    h = (times[i + 1] - times[i])[:, None]
    s = (instants[:, None] - times[i][:, None]) / h
    ends = (1 + 2 * s) * (1 - s) ** 2 * values[i] + s**2 * (3 - 2 * s) * values[i + 1]
    return ends + h * (s * (1 - s) ** 2 * slopes[i] - s**2 * (1 - s) * slopes[i + 1])


def main():
    job, method = jobs.load()
    jobs.answer(job, lambda step, points: march(job, method, step, points))


if __name__ == "__main__":
    main()
