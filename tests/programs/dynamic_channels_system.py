"""Components that open and close channels at random, and write down everything they see of the blackboard."""

from tests.harness.components import sources

WANDERER = '  d/trader: {use: "traders:Wanderer", restart: {limit: 100, backoff_s: 0.01}}\n'


def market(public_url: str, more: str = "", *, wanderer: bool = False) -> dict[str, str]:
    """Returns an application's files: three traders in two stages, one continuous if asked, and a bystander."""
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
    """Returns the files of an application with a writer that opens its channel on command."""
    launch = f"""
name: brief
period_s: 0.02
spare_channels: 1
public_url: {public_url}
components:
  a/writer: {{use: "writer:Writer", restart: {{backoff_s: 0.01}}}}
"""
    return {**sources("writer.py"), "launch/brief.yaml": launch}
