from fwk import Component, Config


class TinyConfig(Config):
    gain: float = 1.0
    names: list[str] = []


class Tiny(Component):
    stage = "think"
    config: TinyConfig
