"""Mistakes in YAML, keys, includes and the run's own values that the check reports."""

from pathlib import Path

import pytest

from fwk.model.errors import PlanError, Problems
from fwk.plan.files import source
from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said


@rows(
    Broken(
        "it.yaml:4: this is not valid YAML: while parsing a flow sequence that begins in line 3, "
        "expected ',' or ']', but got '<stream end>'",
        """
        components:
          it/a: {use: plan_parts:Odometer}
        stages: [sense,
        name: x
        """,
    ),
    Broken(
        """
        it.yaml:2: record: no channel matches 'it/pose'; there is it/odometry
        it.yaml:2: record: no channel matches 'at'; there is it/odometry
        """,
        """
        components: {it/a: {use: plan_parts:Odometer}}
        record: {channels: it/pose, exclude: ["*/odometry", at]}
        """,
    ),
    Broken("it.yaml:2: this is not valid YAML: character '\\x07' is not allowed", "name: x\n# \x07"),
    Broken(
        "it.yaml:4: 'it/a' occurs a second time, first in line 2; keep one",
        """
        components:
          it/a: {use: plan_parts:Odometer}
          it/b: {use: plan_parts:Camera}
          it/a: {use: plan_parts:Watcher}
        """,
    ),
    Broken(
        "it.yaml:2: a key is one word, not a list or a mapping",
        """
        components: {it/a: {use: plan_parts:Odometer}}
        [a, b]: 1
        """,
    ),
    Broken(
        """
        it.yaml:2: this value contains itself; write it out
        it.yaml:2: 'outside.x' is empty; it should be a valid string
        """,
        """
        components: {it/a: {use: plan_parts:Odometer}}
        outside: &all {x: *all}
        """,
    ),
    Broken(
        "it.yaml:1: unknown tag '!secret'; leave it out",
        "seed: !secret 5\ncomponents: {it/a: {use: plan_parts:Odometer}}",
    ),
    Broken(
        "it.yaml:1: 'six' is not a valid int",
        "seed: !!int six\ncomponents: {it/a: {use: plan_parts:Odometer}}",
    ),
    Broken("it.yaml:1: it should be a mapping with keys such as 'name: value'", "[a, b]"),
    Broken("it.yaml:1: values are nested too deeply; use a few levels", f"name: {'[' * 3000}{']' * 3000}"),
    Broken("it.yaml:1: values are nested too deeply; use a few levels", f"name: {'[' * 101}{']' * 101}"),
    Broken(
        "it.yaml:1: more than 100000 values when its aliases are written out; use fewer",
        "a0: &a0 [1, 2, 3, 4, 5, 6, 7, 8, 9]\n"
        + "\n".join(f"a{number}: &a{number} [{', '.join([f'*a{number - 1}'] * 9)}]" for number in range(1, 9)),
    ),
    Broken("it.yaml: there is no component in it; name one under 'components:'", "name: empty"),
    Broken(
        "it.yaml: there is no component in it, only templates; include it in a file with 'robots:'",
        "templates: {rover: {pilot: {use: plan_parts:Pilot}}}",
    ),
)
def test_yaml(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


@rows(
    Broken(
        "it.yaml:1: no key 'componets'; did you mean 'components'?",
        """
        componets:
          it/a: {use: plan_parts:Odometer}
        components:
          it/b: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:2: no key 'components.it/a.confg'; did you mean 'config'?",
        """
        components:
          it/a: {use: plan_parts:Odometer, confg: {gain: 1}}
        """,
    ),
    Broken(
        "it.yaml:4: no key 'components.it/a.restart.limits'; did you mean 'limit'?",
        """
        components:
          it/a:
            use: plan_parts:Odometer
            restart: {limits: 3}
        """,
    ),
    Broken(
        "it.yaml:1: no key 'robots.cyan1.template'; there are config, use, values",
        """
        robots: {cyan1: {use: bot, template: bot}}
        templates: {bot: {a: {use: plan_parts:Odometer}}}
        """,
    ),
    Broken(
        "it.yaml:2: the key 'components.it/a.use' is missing; it has no default",
        """
        components:
          it/a: {ready_timeout_s: 3}
          it/b: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:2: 'components.it/a' is empty; it should be a mapping with keys such as 'name: value'",
        """
        components:
          it/a:
          it/b: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:1: 'robots.cyan1.values.team' is [1]; it should be a word or a number",
        """
        robots: {cyan1: {use: bot, values: {team: [1]}}}
        templates: {bot: {a: {use: plan_parts:Odometer}}}
        """,
    ),
    Broken(
        "it.yaml:1: 'log.syslog_to' is 'localhost'; it should be a socket's path, or an address and port "
        "such as 10.0.0.7:514",
        "log: {syslog_to: localhost}\ncomponents: {it/a: {use: plan_parts:Odometer}}",
    ),
    Broken(
        """
        it.yaml:1: 'period_s' is 0; it should be greater than or equal to 0.001
        it.yaml:2: 'clock' is 'real'; it should be 'simulated' or 'wall'
        it.yaml:3: 'speed' is -1; it should be a number from 1e-06 to 1e+06, or max
        it.yaml:4: 'seed' is true; it should be a number
        it.yaml:5: 'stage_time_s' is 'long'; it should be a valid number, unable to parse string as a number
        """,
        """
        period_s: 0
        clock: real
        speed: -1
        seed: true
        stage_time_s: long
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        """
        it.yaml:1: 'speed' is nan; it should be a number from 1e-06 to 1e+06, or max
        it.yaml:2: 'stage_time_s' is inf; it should be a finite number
        it.yaml:3: 'loop_time_s' is 1e+300; it should be less than or equal to 1000000000
        it.yaml:4: 'log.file_mb' is inf; it should be a finite number
        it.yaml:6: 'components.it/a.ready_timeout_s' is inf; it should be a finite number
        it.yaml:7: 'components.it/b.memory_limit_mb' is 1e+300; it should be less than or equal to 1000000000
        it.yaml:8: 'components.it/c.restart.backoff_s' is inf; it should be a finite number
        it.yaml:9: x/d: 'limits.speed_m_s' is inf; it should be a finite number
        """,
        """
        speed: .nan
        stage_time_s: .inf
        loop_time_s: 1e300
        log: {file_mb: .inf}
        components:
          it/a: {use: plan_parts:Odometer, ready_timeout_s: .inf}
          it/b: {use: plan_parts:Camera, memory_limit_mb: 1e300}
          it/c: {use: plan_parts:Pilot, restart: {backoff_s: .inf}}
          x/d: {use: plan_parts:Wheels, config: {limits: {speed_m_s: .inf}}}
          x/e: {use: plan_parts:Pilot}
        """,
    ),
    Broken(
        "it.yaml:1: 'udpm://[::1]:7667?ttl=0' is not an LCM bus: udpm://GROUP:PORT?ttl=N with an IPv4 multicast group, "
        "such as udpm://239.255.76.67:7667?ttl=0",
        """
        public_url: "udpm://[::1]:7667?ttl=0"
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "it.yaml:1: 'tcpq://' is not a public bus; lcm-spy and Java read only udpm://ADDRESS:PORT, such as "
        "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304",
        """
        public_url: tcpq://
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        """
        it.yaml:1: scoreboard: module 'plan_parts' has no 'gret'; did you mean 'greet'?
        it.yaml:2: video: 42 is not a function
        """,
        """
        scoreboard: plan_parts:gret
        video: plan_parts:answer
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "it.yaml:1: scoreboard: 'plan_parts' is not a function; write module:function",
        """
        scoreboard: plan_parts
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
)
def test_keys_and_values(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


@rows(
    Broken(
        "it.yaml:1: there is no 'otter.yaml' to include; did you mean 'other.yaml'?",
        """
        include: otter.yaml
        --- other.yaml
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "b.yaml:2: files include each other in a cycle: it.yaml -> a.yaml -> b.yaml -> it.yaml; leave one out",
        """
        include: [a.yaml]
        components: {it/a: {use: plan_parts:Odometer}}
        --- a.yaml
        include: b.yaml
        --- b.yaml
        name: b
        include: it.yaml
        """,
    ),
    Broken(
        "parts/a.yaml:1: no key 'nam'; did you mean 'name'?",
        """
        include: [parts/a.yaml]
        components: {it/a: {use: plan_parts:Odometer}}
        --- parts/a.yaml
        nam: a
        """,
    ),
    Broken(
        "it.host.yaml:1: no key 'components'; there are clock, config, cores, evaluation, hosts, log, loop_time_s, "
        "loop_time_warnings, outside, period_s, public_url, record, ...",
        """
        components: {it/a: {use: plan_parts:Odometer}}
        --- it.host.yaml
        components: {it/b: {use: plan_parts:Odometer}}
        """,
    ),
)
def test_several_files(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


@rows(
    Broken(
        "it.yaml:1: 'no-name' is not a valid stage name; use letters, digits and '_'",
        """
        stages: [sensor_acquire, no-name]
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "it.yaml:3: stage 'sensor_acquire' occurs twice; keep one",
        """
        stages:
          - sensor_acquire
          - sensor_acquire
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "it.yaml:1: there are 31 stages; a main loop has 1 to 30",
        f"""
        stages: [sensor_acquire, {", ".join(f"s{n}" for n in range(30))}]
        components: {{it/a: {{use: plan_parts:Odometer}}}}
        """,
    ),
    Broken(
        "it.yaml:2: it/a: no stage 'sensor_acquire'; did you mean 'sensor_aquire'?",
        """
        stages: [sensor_aquire]
        components: {it/a: {use: plan_parts:Odometer}}
        """,
    ),
    Broken(
        "it.yaml:4: it/a: no stage 'thinking'; did you mean 'think'?",
        """
        components:
          it/a:
            use: plan_parts:Odometer
            stage: [worldstate, thinking]
        """,
    ),
    Broken(
        "it.yaml:1: it/a: it takes part in no stage; name at least one",
        "components: {it/a: {use: plan_parts:Odometer, stage: []}}",
    ),
)
def test_stages(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


def test_aliases_are_counted_before_they_are_written_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(source, "_Converter", None)
    further = [f"a{number}: &a{number} [{', '.join(10 * [f'*a{number - 1}'])}]" for number in range(1, 6)]
    problems = Problems()
    assert source.read_text("\n".join(["a0: &a0 [1, 2]", *further]), "it.yaml", problems) is None
    with pytest.raises(PlanError, match="more than 100000 values"):
        problems.stop_if_any()
