"""Instances know nothing of each other, and a reset one nothing of its past."""

from concurrent.futures import ThreadPoolExecutor

from mechanism import grid

POINTS = grid(0.0, 1e-5, 800)


def alone(mechanism, settings={}):
    slave = mechanism.start(settings)
    pictures = slave.run(POINTS)
    slave.free()
    return pictures


def test_two_interleaved_equal_two_alone(wornpin):
    wear = [{"joint.C.clearance": clearance} for clearance in (5e-4, 2e-4)]
    pair, pictures = [wornpin.start(settings) for settings in wear], ([], [])
    for here, there in zip(POINTS, POINTS[1:]):
        for slave, seen in zip(pair, pictures):
            slave.fmu.doStep(here, there - here)
            seen.append(slave.picture())
    for slave, seen, settings in zip(pair, pictures, wear):
        slave.free()
        assert seen == alone(wornpin, settings)
    assert pictures[0] != pictures[1]


def test_instances_of_different_scenes_live_side_by_side(wornpin, allplay, press):
    mechanisms = [wornpin, allplay, press]
    slaves, pictures = [mechanism.start() for mechanism in mechanisms], [[], [], []]
    for here, there in zip(POINTS, POINTS[1:]):
        for slave, seen in zip(slaves, pictures):
            slave.fmu.doStep(here, there - here)
            seen.append(slave.picture())
    for slave in slaves:
        slave.free()
    assert pictures == [alone(mechanism) for mechanism in mechanisms]


def test_eight_in_parallel_threads_equal_one_alone(wornpin):
    with ThreadPoolExecutor(8) as pool:
        runs = list(pool.map(lambda _: alone(wornpin), range(8)))
    assert all(run == runs[0] for run in runs)


def test_created_stepped_and_freed_by_different_threads(wornpin):
    def elsewhere(work):
        with ThreadPoolExecutor(1) as thread:
            return thread.submit(work).result()

    slave = elsewhere(wornpin.start)
    pictures = elsewhere(lambda: slave.run(POINTS))
    elsewhere(slave.free)
    assert pictures == alone(wornpin)


def test_reset_brings_the_first_run_back_again_and_again(wornpin):
    slave = wornpin.start()
    first = slave.run(POINTS)
    for clearance in (1e-4, 2e-4, None):
        slave.fmu.reset()
        if clearance:
            slave.set({"joint.C.clearance": clearance, "gravity": 9.81})
        slave.fmu.setupExperiment(startTime=0.0)
        slave.initialize()
        again = slave.run(POINTS)
        assert (again == first) == (clearance is None)
    slave.free()


def test_one_may_be_freed_while_another_runs(wornpin):
    survivor = wornpin.start()
    pictures = survivor.run(POINTS[:401])
    for _ in range(3):
        wornpin.start().free()  # FMPy closes the library too
    pictures += survivor.run(POINTS[400:])
    survivor.free()
    assert pictures == alone(wornpin)
