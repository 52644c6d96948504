"""Examples at the end of each command's help and in docs/commands.md."""

from typing import Any

EXAMPLES = {
    "fwk-launch": (
        "fwk-launch robots.yaml --ticks 1200 --speed max --seed 7",
        "fwk-launch robots.yaml --run red --detach",
        "fwk-launch robots.yaml --set cyan1/omni_ball.deviation_px=2 --without 'magenta*'",
    ),
    "fwk new project": ("fwk new project garden",),
    "fwk new component": ("fwk new component tracker", "fwk new component gripper --kind driver --launch robots.yaml"),
    "fwk new interface": (
        "fwk new interface garden.moisture percent:double",
        "fwk new interface garden.scan n:int32_t 'ranges_m:float[n]'",
    ),
    "fwk new launch": ("fwk new launch trial", "fwk new launch trial tracker sensor --namespace red"),
    "fwk add reads": (
        "fwk add reads tracker ball:garden.ball_t",
        "fwk add reads tracker motor:drive.motor_t --each --history 20",
    ),
    "fwk add writes": ("fwk add writes tracker pose:drive.pose_t --dry-run",),
    "fwk add serves": ("fwk add serves tap pour:tap.pour_t level:tap.level_request_t,tap.level_t",),
    "fwk add calls": ("fwk add calls gardener pour:tap.pour_t --channel house/pour",),
    "fwk add setting": ("fwk add setting tracker gain:float=0.3 --meaning '0 keeps the old value, 1 takes the new.'",),
    "fwk remove reads": ("fwk remove reads tracker ball",),
    "fwk remove setting": ("fwk remove setting tracker gain",),
    "fwk types": ("fwk types --lang c native/types", "fwk types --lang java build/types"),
    "fwk check": ("fwk check robots.yaml", "fwk check robots.yaml --settings --set cyan1/omni_ball.deviation_px=2"),
    "fwk ps": ("fwk ps --json",),
    "fwk status": ("fwk status", "fwk status 'cyan1/*' --run red", "fwk status cyan1/world_model"),
    "fwk top": ("fwk top", "fwk top --once --since start"),
    "fwk start": ("fwk start cyan1/world_model",),
    "fwk stop": ("fwk stop 'cyan2/*'", "fwk stop cyan1/camera --force", "fwk stop --all --run red"),
    "fwk restart": ("fwk restart cyan1/world_model",),
    "fwk reload": ("fwk reload 'cyan1/*'",),
    "fwk load": ("fwk load cyan1/omni_ball",),
    "fwk unload": ("fwk unload cyan1/camera --force",),
    "fwk kill": ("fwk kill cyan1/world_model",),
    "fwk debug": ("fwk debug cyan1/world_model",),
    "fwk pause": ("fwk pause",),
    "fwk resume": ("fwk resume --run red",),
    "fwk step": ("fwk step", "fwk step 20"),
    "fwk speed": ("fwk speed 0.5", "fwk speed max"),
    "fwk config list": ("fwk config list 'cyan1/*'",),
    "fwk config get": ("fwk config get cyan1/omni_ball.deviation_px",),
    "fwk config set": ("fwk config set cyan1/omni_ball.deviation_px=2",),
    "fwk graph": (
        "fwk graph --file robots.yaml --out robots.svg",
        "fwk graph 'cyan1/*' --run red",
        "fwk graph --file robots.yaml --form mermaid",
    ),
    "fwk who": ("fwk who cyan1/pose", "fwk who '*/pose' --file robots.yaml"),
    "fwk bb list": ("fwk bb list 'cyan1/*'",),
    "fwk bb show": ("fwk bb show cyan1/world_model", "fwk bb show cyan1/world_model --json"),
    "fwk bb watch": ("fwk bb watch cyan1/odometry", "fwk bb watch cyan1/pose --field x_m --field y_m"),
    "fwk log": (
        "fwk log -f --level warning",
        "fwk log --last 20 --component 'cyan1/*'",
        "fwk log --tick 100..200 --text 'lost|late'",
    ),
    "fwk note": ("fwk note 'the ball was taken away'",),
    "fwk send": ("fwk send rosy/motor_command vx_m_s=0.2 enabled=true",),
    "fwk play": (
        "fwk play log.lcm --speed 0.5",
        "fwk play log.lcm --from 12.5s --to 'ball was taken' --loop --channels 'cyan1/*'",
        "fwk play heard.lcm --remap cyan1/pose=cyan2/pose --plugin my_plugins:Noise",
    ),
    "fwk replay": (
        "fwk replay log.lcm --verify",
        "fwk replay log.lcm --only 'cyan1/*' --from-tick 100",
        "fwk replay log.lcm --debug cyan1/world_model --from-tick 500",
        "fwk replay log.lcm --to-tick 1200 --then-live --set cyan1/world_model.ball_timeout_s=0.5 --record brief.lcm",
    ),
    "fwk bisect": (
        "fwk bisect log.lcm --good v1.2 --bad HEAD --only cyan1/agent",
        "fwk bisect log.lcm --good HEAD~20 --when 'cyan1.odometry.x_m > 3'",
    ),
    "fwk compare": ("fwk compare before.lcm after.lcm",),
    "fwk log-info": ("fwk log-info log.lcm", "fwk log-info log.lcm --check --json"),
    "fwk cut": (
        "fwk cut log.lcm --from 12.5s --to 20s --out goal.lcm",
        "fwk cut log.lcm --from 'ball taken away' --channels 'cyan1/*' --out part.lcm",
        "fwk cut RUN --last 30 --out just-now.lcm",
    ),
    "fwk filter": (
        "fwk filter log.lcm --channels 'cyan1/*' --out cyan1.lcm",
        "fwk filter log.lcm --exclude '*/image' --out small.lcm",
        "fwk filter log.lcm --type 'robot.*' --out robots.lcm",
    ),
    "fwk merge": ("fwk merge log.lcm heard.lcm --align --out both.lcm",),
    "fwk compress": ("fwk compress log.lcm", "fwk compress RUN"),
    "fwk repair": ("fwk repair log.lcm --out whole.lcm",),
    "fwk export": (
        "fwk export log.lcm --out log.mcap",
        "fwk export log.lcm --to csv --out tables --channels 'cyan1/*'",
        "fwk export log.lcm --to jsonl --type 'robot.*' --out robots.jsonl",
    ),
    "fwk import": ("fwk import log.mcap --out log.lcm",),
    "fwk plot": (
        "fwk plot cyan1/odometry.vx_m_s 'cyan*/pose.x_m' --last 20",
        "fwk plot cyan1/odometry.x_m --from RUN",
        "fwk plot cyan1/odometry.x_m cyan1/odometry.vx_m_s --from log.lcm --out drive.png",
        "fwk plot 'cyan*/world_model.ball.x_m' --from log.lcm --out ball.svg",
    ),
    "fwk runs list": ("fwk runs list",),
    "fwk video": ("fwk video log.lcm --out run.mp4",),
    "fwk eval": (
        "fwk eval robots.yaml --seeds 1..20 --time 60",
        "fwk eval robots.yaml --set '*/localization.points=50' --out fewer-points",
        "fwk eval robots.yaml --seeds 1..100 --cluster tcp://192.168.1.5:8786",
    ),
    "fwk web": ("fwk web", "fwk web --run red --read-only", "fwk web --view yard_view --port 8000"),
    "fwk view": ("fwk view --from RUN", "fwk view --web", "fwk view --from log.lcm --save run.rrd"),
    "fwk foxglove": ("fwk foxglove", "fwk foxglove --run red --port 9000"),
    "fwk monitor": (
        "fwk monitor --template imu",
        "fwk monitor turns.py --run red",
        "fwk monitor turns.py --from log.lcm --count 100",
    ),
    "fwk spy": ("fwk spy",),
    "fwk doctor": ("fwk doctor", "fwk doctor robots.yaml"),
    "fwk completion": ('eval "$(fwk completion bash)"',),
}
"""Command, as it is typed, to examples of it."""


def epilog(path: str) -> str | None:
    """Returns the end of a command's help; None without examples."""
    examples = EXAMPLES.get(path)
    return "\n\n".join(["Examples:", *examples]) if examples else None


def add_examples(path: str, command: Any) -> None:
    """Adds examples to the help of a command, or of each command of a group."""
    command.epilog = epilog(path)
    for name, below in getattr(command, "commands", {}).items():
        add_examples(f"{path} {name}", below)
