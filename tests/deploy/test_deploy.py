"""The files in deploy/ are what they should be, as far as that shows without an engine."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

from muster.cli.main import run
from muster_control.cli.serve import command

_FOLDER = Path(__file__).parents[2] / "deploy"
_INSTRUCTIONS = {
    "CMD",
    "COPY",
    "ENTRYPOINT",
    "ENV",
    "EXPOSE",
    "FROM",
    "HEALTHCHECK",
    "RUN",
    "STOPSIGNAL",
    "USER",
    "VOLUME",
    "WORKDIR",
}


def _text(name):
    return (_FOLDER / name).read_text(encoding="utf-8")


def _options_of_serve():
    return {option for parameter in command.params for option in parameter.opts if option.startswith("--")}


def _instructions():
    """Of the container file: each with its words, where lines that end in a backslash are one."""
    lines = [line for line in _text("Containerfile").splitlines() if not line.lstrip().startswith("#")]
    joined = "\n".join(lines).replace("\\\n", " ")
    return [tuple(line.split(None, 1)) for line in joined.splitlines() if line.strip()]


def _health_check():
    """Of the container file: a program and its words."""
    return yaml.safe_load(dict(_instructions())["HEALTHCHECK"].partition("CMD")[2])


@pytest.mark.parametrize("name", sorted(path.name for path in _FOLDER.iterdir()))
def test_options_are_those_of_serve(name):
    """What the files pass to `muster serve`, in comments too, is there."""
    known = _options_of_serve() | {"--help"}
    for line in re.findall(r"muster serve[^`\n]*(?:\\\n[^`\n]*)*", _text(name)):
        assert set(re.findall(r"--[a-z-]+", line)) <= known


def test_container_file():
    instructions = _instructions()
    names = [name for name, _ in instructions]
    assert set(names) <= _INSTRUCTIONS
    assert names[0] == "FROM"
    last = instructions[len(names) - 1 - names[::-1].index("FROM") :]
    final = dict(last)
    assert final["USER"] == "muster"
    assert names.index("VOLUME") > names.index("USER")
    for name in ("ENTRYPOINT", "HEALTHCHECK"):
        form = final[name].partition("CMD")[2] if name == "HEALTHCHECK" else final[name]
        assert all(isinstance(word, str) for word in yaml.safe_load(form))
    entry = yaml.safe_load(final["ENTRYPOINT"])
    assert entry[:2] == ["muster", "serve"]
    assert {word for word in entry if word.startswith("--")} <= _options_of_serve()
    assert "--tokens" in entry


def test_shell_of_the_container_file():
    for name, words in _instructions():
        if name == "RUN":
            subprocess.run(["sh", "-n", "-c", words], check=True)


def test_code_of_the_health_check():
    compile(_health_check()[-1], "HEALTHCHECK", "exec")


def test_compose_file():
    compose = yaml.safe_load(_text("compose.yaml"))
    services = compose["services"]
    for service in services.values():
        assert ("image" in service) != ("build" in service)
        assert set(service.get("networks", [])) <= set(compose["networks"])
        assert set(service.get("depends_on", [])) <= set(services)
        named = {volume.partition(":")[0] for volume in service["volumes"]}
        assert {name for name in named if not name.startswith(".")} <= set(compose["volumes"])
    assert "ports" not in services["muster"]  # the proxy alone is reached from outside
    assert "ports" not in services["database"]
    words = services["muster"]["command"]
    assert {word for word in words if word.startswith("--")} <= _options_of_serve()
    assert (_FOLDER / services["muster"]["build"]["context"] / services["muster"]["build"]["dockerfile"]).is_file()


def test_the_health_check_is_kept_by_podman():
    """Its own format of images leaves HEALTHCHECK out."""
    builds = re.findall(r"podman build [^`\n]*", _text("Containerfile"))
    assert builds
    assert all("--format docker " in build for build in builds)
    service = yaml.safe_load(_text("compose.yaml"))["services"]["muster"]
    assert service["healthcheck"]["test"] == ["CMD", *_health_check()]


def test_who_is_waited_for_says_how_it_is():
    services = yaml.safe_load(_text("compose.yaml"))["services"]
    for name, other in (("muster", "database"), ("proxy", "muster")):
        assert services[name]["depends_on"] == {other: {"condition": "service_healthy"}}
        assert "healthcheck" in services[other]


def test_tokens_are_mounted_with_their_folder():
    """A line that is deleted is to count, however the editor writes the file."""
    (mount,) = (v for v in yaml.safe_load(_text("compose.yaml"))["services"]["muster"]["volumes"] if v.startswith("."))
    there, inside, mode = mount.split(":")
    entry = yaml.safe_load(dict(_instructions())["ENTRYPOINT"])
    tokens = Path(entry[entry.index("--tokens") + 1])
    assert (Path(inside), mode) == (tokens.parent, "ro")
    (made,) = re.findall(r"muster serve --new-token .* --tokens (\S+)", _text("compose.yaml"))
    assert Path(made) == Path("deploy", there, tokens.name)


def test_the_proxy_of_the_compose_file_is_the_one_of_the_caddyfile():
    compose, caddy = yaml.safe_load(_text("compose.yaml")), _text("Caddyfile")
    origin = compose["services"]["muster"]["command"][1]
    assert re.search(rf"^{re.escape(origin.removeprefix('https://'))} {{$", caddy, re.MULTILINE)
    assert "reverse_proxy muster:8117 {" in caddy
    assert caddy.count("{") == caddy.count("}")


def test_nginx():
    """Braces, and a semicolon at the end of every directive; WebSockets and who asks are passed on."""
    lines = [line.partition(" #")[0].strip() for line in _text("nginx.conf").splitlines() if not line.startswith("#")]
    assert all(line[-1] in "{};\\" for line in lines if line)
    assert sum(line.count("{") for line in lines) == sum(line.count("}") for line in lines)
    assert "proxy_set_header Upgrade $http_upgrade;" in lines
    assert "proxy_set_header X-Forwarded-User $remote_user;" in lines
    assert "include /etc/nginx/muster-secret.conf;" in lines  # without it the server believes no user of the proxy
    assert "proxy_set_header X-Muster-Proxy-Secret $(cat /etc/muster/proxy-secret);" in _text("nginx.conf")


def _unit():
    lines = [line for line in _text("muster.service").splitlines() if line and not line.startswith("#")]
    return [line for line in lines if not line.startswith("[")]


def test_unit():
    settings = dict(line.split("=", 1) for line in _unit())
    wanted = {"DynamicUser": "yes", "ProtectSystem": "strict", "Restart": "on-failure", "StateDirectory": "muster"}
    assert wanted.items() <= settings.items()
    options = set(re.findall(r"--[a-z-]+", settings["ExecStart"]))
    assert "--tokens" in options
    assert options <= _options_of_serve()


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
def test_systemd_understands_the_unit(tmp_path):
    program = tmp_path / "muster"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    unit = tmp_path / "muster.service"
    unit.write_text(_text("muster.service").replace("/opt/muster/bin/muster", str(program)), encoding="utf-8")
    result = subprocess.run(["systemd-analyze", "verify", unit], capture_output=True, text=True)
    assert (result.returncode, result.stderr) == (0, "")


def test_the_lines_that_make_a_token(tmp_path):
    assert run(["serve", "--new-token", "anna", "--role", "command", "--tokens", str(tmp_path / "tokens")]) == 0
    assert (tmp_path / "tokens").read_text().startswith("command anna ")
