"""``python -m twodiscs``: the command line, where the command itself is not on the path."""

from twodiscs.cli import main

if __name__ == "__main__":
    main()
