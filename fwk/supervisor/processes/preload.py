"""Work shared by all components of a class, done once before processes are forked."""

import json
from contextlib import suppress
from importlib import import_module

from fwk.component.component import Component
from fwk.component.declaration import declaration
from fwk.lcm import codec
from fwk.lcm.messages import type_named
from fwk.model.plan import Plan


def preload(plan: Plan) -> None:
    """Makes the codecs of all channels and calls `preload` once for every component class and its settings."""
    for type_name in sorted({channel.type_name for channel in plan.channels}):
        codec.encoder(type_named(type_name))
        codec.decoder(type_named(type_name))
    done = set()
    for planned in plan.components:
        key = (planned.module, planned.class_name, json.dumps(planned.config, sort_keys=True, default=str))
        component: type[Component] = getattr(import_module(planned.module), planned.class_name)
        if key in done or component.preload.__func__ is Component.preload.__func__:  # type: ignore[attr-defined]
            continue
        done.add(key)
        config_type = declaration(component).config
        with suppress(Exception):  # the component's own `init` reports the mistake, with its name
            component.preload(config_type.model_validate(planned.config))
