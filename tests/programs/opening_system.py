"""Components that open and close channels as they like, and write down all that they see of the blackboard."""

from tests.harness.components import sources

WANDERER = '  d/trader: {use: "traders:Wanderer", restart: {limit: 100, backoff_s: 0.01}}\n'


def market(public_url: str, more: str = "", *, wanderer: bool = False) -> dict[str, str]:
    """The files of an application: three traders in two stages, if asked for one at its own pace, and a bystander."""
    launch = f"""
name: market
period_s: 0.02
speed: max
spare_channels: 14
public_url: {public_url}
components:
  a/trader: {{use: "traders:Trader", restart: {{limit: 100, backoff_s: 0.01}}}}
  b/trader: {{use: "traders:Trader", stage: skill, restart: {{limit: 100, backoff_s: 0.01}}}}
  c/trader: {{use: "traders:Trader", restart: {{limit: 100, backoff_s: 0.01}}}}
  a/bystander: {{use: "traders:Bystander"}}
{WANDERER if wanderer else ""}{more}
"""
    return {**sources("traders.py"), "launch/market.yaml": launch}


def brief(public_url: str) -> dict[str, str]:
    """The files of an application with a writer that opens its channel when it is told to."""
    launch = f"""
name: brief
period_s: 0.02
spare_channels: 1
public_url: {public_url}
components:
  a/writer: {{use: "writer:Writer", restart: {{backoff_s: 0.01}}}}
"""
    return {**sources("writer.py"), "launch/brief.yaml": launch}
