"""The types that the package is annotated with hold."""

from mypy import api

from slidercrank import source


def test_the_package_is_strictly_typed(tmp_path):
    package = source.home() / "fmu-harness/python/slidercrank"
    # What others wrote without annotations may be called, and is taken as it comes.
    rules = ["--strict", "--allow-untyped-calls", "--ignore-missing-imports"]
    told, complained, status = api.run([*rules, "--cache-dir", str(tmp_path), str(package)])
    assert status == 0, told + complained
