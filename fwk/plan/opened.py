"""`--outside`: channels whose writer is left out, and which programs outside write in its place."""

from collections.abc import Container, Iterable, Sequence
from fnmatch import fnmatchcase

from fwk.lcm import envelope, messages
from fwk.lcm.messages import Message
from fwk.model.errors import Problems, hint
from fwk.model.names import LINES
from fwk.model.plan import NOBODY, ChannelPlan
from fwk.model.service_channels import is_of_service

OPTION = "--outside"


def opened(
    channels: Sequence[ChannelPlan],
    names: Sequence[str],
    kept: Container[str],
    patterns: Iterable[str],
    problems: Problems,
) -> dict[str, type[Message]]:
    """Returns the channels that these patterns select and no component of the run writes, with their types.

    Args:
        channels: the channels of all components.
        names: these components, in their order.
        kept: those that run.
        patterns: channels, or patterns such as `cyan1/*`.
        problems: gets each pattern that selects none.
    """
    known = [each for each in channels if not (is_of_service(each.name) or each.images or each.name == LINES)]
    free = {each.name for each in known if each.writer == NOBODY or names[each.writer] not in kept}
    found: dict[str, type[Message]] = {}
    for pattern in patterns:
        meant = [each for each in known if fnmatchcase(each.name, pattern)]
        if not meant:
            problems.add(OPTION, "", f"no channel '{pattern}'; {hint(pattern, [each.name for each in known])}")
        elif free.isdisjoint(each.name for each in meant):
            writers = " ".join(dict.fromkeys(names[each.writer] for each in meant))
            problems.add(OPTION, "", f"'{pattern}' is written by {writers}; leave it out: --without {writers}")
        for each in meant:
            kind = messages.type_named(each.type_name)
            if each.name in free and (mistake := envelope.mistake_in(kind)):
                problems.add(OPTION, "", f"{each.name}: {mistake}")
            elif each.name in free:
                found[each.name] = kind
    return found
