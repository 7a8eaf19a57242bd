"""How other hosts call, as measured with a spy: each of their ways leads to the plain run's bits.

Those hosts do not install from a package registry; their ways are re-enacted through FMPy's
low-level calls, and by fmuloader, which binds every function of the standard.
"""

import ctypes
import resource
import shutil

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2StepFinishedTYPE,
)

from mechanism import Mechanism, grid

POINTS = grid(0.0, 1e-4, 120)


class Ears:
    """A host's logger, and callbacks with nothing but it."""

    def __init__(self):
        self.heard = []

        def log(environment, name, status, category, message):
            self.heard.append((environment, name, status, category, message))

        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(log)
        self.callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE()  # NULL
        self.callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE()
        self.callbacks.stepFinished = fmi2StepFinishedTYPE()
        self.callbacks.componentEnvironment = 0x5C


@pytest.fixture
def plain(wornpin):
    slave = wornpin.start()
    yield slave.run(POINTS)
    slave.free()


def test_fmusim_gives_no_resources_and_no_memory(wornpin, plain):
    ears = Ears()
    slave = wornpin.instantiate(location=None, callbacks=ears.callbacks)
    # Tolerance and stop time are undefined, and zero.
    slave.fmu.fmi2SetupExperiment(slave.fmu.component, 0, 0.0, 0.0, 0, 0.0)
    slave.initialize()
    everything = [variable.name for variable in wornpin.outputs()]
    pictures = []
    for here, there in zip(POINTS, POINTS[1:]):
        slave.fmu.doStep(here, there - here, 0)
        for name in everything:
            slave.get(name)
        pictures.append(slave.picture())
    slave.free()
    assert pictures == plain
    assert ears.heard == []


def test_fmu_check_logs_and_reads_every_variable(wornpin):
    ears = Ears()
    slave = wornpin.instantiate(callbacks=ears.callbacks, logging=1)
    assert slave.fmu.getVersion() == "2.0"
    assert slave.fmu.getTypesPlatform() == "default"
    slave.fmu.setDebugLogging(True, [])
    # Not defined, but a value all the same.
    slave.fmu.fmi2SetupExperiment(slave.fmu.component, 0, 1e-6, 0.0, 0, 0.0)
    slave.initialize()
    step, points = 0.00099999999999993, [0.0]
    while len(points) <= 12:
        here = points[-1]
        slave.fmu.doStep(here, step)
        points.append(here + step)
        assert len([slave.get(name) for name in wornpin.variables]) == len(wornpin.variables)
    last = slave.picture()
    slave.fmu.terminate()
    slave.free()
    assert ears.heard == [], "a run without trouble has nothing to say"
    other = wornpin.start()
    assert other.run(points)[-1] == last
    other.free()


def test_omsimulator_passes_a_stop_time_that_does_not_count(wornpin):
    ears = Ears()
    location = "file:////" + str(wornpin.directory / "resources")
    slave = wornpin.instantiate(location=location, callbacks=ears.callbacks, visible=1, logging=1)
    stop = POINTS[24]
    slave.fmu.fmi2SetupExperiment(slave.fmu.component, 1, 1e-4, 0.0, 0, stop)
    slave.fmu.enterInitializationMode()
    # Reads in initialization mode, and outputs follow what was set there.
    slave.set({"crank.angle_start": 0.5})
    assert slave.get("crank.angle") == 0.5
    slave.set({"crank.angle_start": 0.0})
    assert slave.get("crank.angle") == 0.0
    slave.fmu.exitInitializationMode()
    pictures = slave.run(POINTS)  # five times as far
    slave.free()
    assert ears.heard == []
    other = wornpin.start(tolerance=1e-4)
    assert other.run(POINTS) == pictures
    other.free()


def test_omsimulator_sets_and_reads_without_a_step(ideal):
    slave = ideal.start()
    free = slave.get("joint.C.force.x")
    for load in (10.0, -20.0, 0.0):
        slave.set({"slider.load": load})
        assert slave.get("slider.load") == load
        assert slave.get("joint.C.force.x") == pytest.approx(free - load, abs=1e-9)
    assert slave.get("joint.C.force.x") == free
    slave.free()


def test_omsimulators_shell_takes_every_step_twice(wornpin, plain):
    slave, pictures = wornpin.start(), []
    for here, there in zip(POINTS, POINTS[1:]):
        state = slave.fmu.getFMUstate()
        slave.fmu.doStep(here, there - here, 1)
        once = slave.picture()
        slave.fmu.setFMUstate(state)
        slave.fmu.doStep(here, there - here, 1)
        pictures.append(slave.picture())
        assert pictures[-1] == once
        slave.fmu.freeFMUstate(state)
    slave.free()
    assert pictures == plain


def test_omsimulator_extrapolates_inputs_by_output_derivatives(press):
    """Each step asks for slopes of outputs and hands slopes of inputs on; slopes of 0 change nothing."""
    slopes = press.references(["crank.speed", "slider.x"])
    inputs = press.references(["crank.torque", "slider.load"])
    slave, pictures = press.start(), []
    for here, there in zip(POINTS, POINTS[1:]):
        assert len(slave.fmu.getRealOutputDerivatives(slopes, [1, 1])) == 2
        slave.fmu.setReal(inputs, [0.0, 0.0])
        slave.fmu.setRealInputDerivatives(inputs, [1, 1], [0.0, 0.0])
        slave.fmu.doStep(here, there - here)
        pictures.append(slave.picture())
    slave.free()
    other = press.start()
    assert other.run(POINTS) == pictures
    other.free()


def test_ecos_names_an_instance_by_its_path_with_spaces(tmp_path, wornpin, plain):
    place = tmp_path / "two words {braced}"
    place.mkdir()
    mechanism = Mechanism(wornpin.file, into=str(place / "unpacked fmu"))
    ears = Ears()
    for prefix in ("file:////", "file:///", "file://localhost/", "file:/"):
        location = prefix + str(mechanism.directory / "resources").lstrip("/")
        slave = mechanism.instantiate(str(mechanism.directory), location=location, callbacks=ears.callbacks, logging=1)
        slave.fmu.setupExperiment()
        slave.initialize()
        assert slave.run(POINTS) == plain
        slave.free()
    assert ears.heard == []


def test_cofmupy_sets_before_the_experiment_and_never_frees(wornpin, plain):
    slave = wornpin.instantiate()
    slave.set({"slider.load": 0.0, "joint.C.clearance": 1e-4})
    slave.set({"joint.C.clearance": wornpin_start(wornpin, "joint.C.clearance")})
    slave.fmu.setupExperiment(startTime=0.0)
    slave.initialize()
    before, pictures = peak_kilobytes(), []
    for here, there in zip(POINTS, POINTS[1:]):
        for _ in range(20):  # iterations of the master
            slave.fmu.getFMUstate()
        slave.fmu.doStep(here, there - here)
        pictures.append(slave.picture())
    assert pictures == plain
    # 2400 states that nobody frees: some 8 kB each is what a long run can bear.
    assert peak_kilobytes() - before < 2400 * 8
    # Neither Terminate nor FreeInstance: the process simply ends.


def wornpin_start(mechanism, name):
    return float(mechanism.variables[name].start)


def peak_kilobytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def test_fmucontainer_brings_all_up_to_initialization_before_any_leaves_it(wornpin, plain):
    slaves = [wornpin.instantiate(f"container/{name}") for name in ("a", "b")]
    for slave in slaves:
        slave.fmu.fmi2SetupExperiment(slave.fmu.component, 0, 1e-8, 0.0, 0, 1.0)
    for slave in slaves:
        slave.fmu.enterInitializationMode()
    for slave in slaves:
        slave.fmu.exitInitializationMode()
    pictures = [[], []]
    for here, there in zip(POINTS, POINTS[1:]):
        for slave, seen in zip(slaves, pictures):
            slave.fmu.doStep(here, there - here)
            seen.append(slave.picture())
    for slave in slaves:
        slave.free()
    assert pictures == [plain, plain]


def test_a_host_that_binds_every_function_finds_them(wornpin, plain):
    """fmuloader binds the ten functions of model exchange as well: they are there and refuse."""
    from fmuloader.fmi2 import Fmi2Error, Fmi2Slave, Fmi2Status, Fmi2Type

    description = wornpin.description
    slave = Fmi2Slave(wornpin.file, model_identifier=description.coSimulation.modelIdentifier)
    slave.instantiate("loaded", Fmi2Type.CO_SIMULATION, guid=description.guid)
    slave.setup_experiment(start_time=0.0)
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    for refused in (slave.enter_event_mode, slave.enter_continuous_time_mode, lambda: slave.set_time(0.0)):
        with pytest.raises(Fmi2Error) as refusal:
            refused()
        assert refusal.value.status == Fmi2Status.ERROR
    position = wornpin.references(["slider.x"])
    for here, there in zip(POINTS, POINTS[1:]):
        slave.do_step(here, there - here)
    twin = wornpin.start()
    twin.run(POINTS)
    assert slave.get_real(position) == [twin.get("slider.x")]
    twin.free()
    slave.terminate()
    slave.free_instance()


def test_only_the_standards_functions_and_those_for_estimators_are_exported(wornpin):
    """A host that loads several units with global symbols would mix up anything else."""
    symbols = exported(wornpin.directory / "binaries" / "linux64" / "SliderCrank.so")
    starts = ("fmi2", "fmi3", "slidercrank_")
    # Three for estimators in each version.
    assert [sum(symbol.startswith(start) for symbol in symbols) for start in starts] == [44, 75, 6]
    assert len(symbols) == 44 + 75 + 6


def exported(library):
    """Names of the dynamic symbol table's defined entries, read as ELF64 lays them out."""
    data = library.read_bytes()
    at = lambda offset, kind: kind.from_buffer_copy(data, offset).value  # noqa: E731
    u16, u32, u64 = ctypes.c_uint16, ctypes.c_uint32, ctypes.c_uint64
    sections, size, count = at(0x28, u64), at(0x3A, u16), at(0x3C, u16)
    headers = [sections + number * size for number in range(count)]
    table = next(header for header in headers if at(header + 4, u32) == 11)  # SHT_DYNSYM
    strings = at(headers[at(table + 40, u32)] + 24, u64)
    first, length = at(table + 24, u64), at(table + 32, u64)
    names = set()
    for entry in range(first, first + length, 24):
        if at(entry + 6, u16) != 0:  # SHN_UNDEF
            begin = strings + at(entry, u32)
            names.add(data[begin : data.index(b"\0", begin)].decode())
    return names


def test_a_wrong_guid_is_refused_aloud_and_the_host_lives(wornpin):
    ears = Ears()
    right = wornpin.description.guid
    wornpin.description.guid = "{00000000-0000-0000-0000-000000000000}"
    try:
        with pytest.raises(AssertionError, match="not instantiated"):
            wornpin.instantiate(callbacks=ears.callbacks)
    finally:
        wornpin.description.guid = right
    ((environment, name, status, category, message),) = ears.heard
    assert (environment, name, status) == (0x5C, b"mechanism", 3)
    assert category == b"logStatusError" and right.encode() in message and b"%" not in message


def test_unknown_variables_and_calls_out_of_order_are_refused_by_name(wornpin):
    ears = Ears()
    slave = wornpin.instantiate(callbacks=ears.callbacks, logging=1)
    speed = wornpin.references(["crank.speed"])
    for bad in (
        lambda: slave.fmu.doStep(0.0, 1e-3),
        lambda: slave.fmu.getReal(speed),
        lambda: slave.fmu.getReal([123456]),
        lambda: slave.fmu.setReal(speed, [1.0]),
        lambda: slave.fmu.getInteger(speed),
        lambda: slave.fmu.exitInitializationMode(),
        lambda: slave.fmu.cancelStep(),
    ):
        count = len(ears.heard)
        with pytest.raises(FMICallException) as refusal:
            bad()
        assert refusal.value.status == 3
        assert len(ears.heard) == count + 1, "one line for one fault"
        assert b"%" not in ears.heard[-1][4]
    assert any(b"crank.speed" in message for *_, message in ears.heard)
    slave.fmu.setupExperiment()
    slave.initialize()
    slave.free()


def test_hosts_that_look_at_no_status_hear_of_trouble_with_logging_off(wornpin):
    """ecos and fmi-sim go on with the start value; their users must read why."""
    ears = Ears()
    slave = wornpin.instantiate(callbacks=ears.callbacks, logging=0)
    clearance = wornpin.references(["joint.C.clearance"])
    with pytest.raises(FMICallException):
        slave.fmu.setReal(clearance, [0.0])
    ((*_, status, category, message),) = ears.heard
    assert (status, category) == (3, b"logStatusError") and b"joint.C.clearance = 0 is out of range" in message
    # A category that is not declared is a warning, and the others of the call count.
    slave.fmu.setDebugLogging(True, ["no such category", "logRemark"])
    assert ears.heard[-1][2:4] == (1, b"logStatusWarning") and b"no such category" in ears.heard[-1][4]
    slave.free()


def test_the_run_needs_no_file_but_the_library(wornpin, plain, tmp_path):
    lonely = Mechanism(wornpin.file, into=str(tmp_path / "lonely"))
    for entry in lonely.directory.iterdir():
        if entry.name != "binaries":
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
    slave = lonely.start(location=None)
    assert slave.run(POINTS) == plain
    slave.free()
