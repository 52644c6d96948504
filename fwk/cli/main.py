"""Entry point of the `fwk` command."""


def main() -> None:
    """Runs the command line."""
    from fwk.cli.commands import app

    app(prog_name="fwk")


if __name__ == "__main__":
    main()
