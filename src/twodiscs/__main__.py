"""``python -m twodiscs``: the command line, if the command is not on the path."""

from twodiscs.cli import main

if __name__ == "__main__":
    main()
