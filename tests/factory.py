"""Rows of any table, made from its class: a test says the columns that it is about."""


def row(table, **given):
    """Return a row of a ``table`` with what is ``given``; other columns are empty.

    Raises ``TypeError`` for a column that the table does not have.
    """
    columns = table.columns()
    if unknown := given.keys() - columns.keys():
        raise TypeError(f"{table.name()}.csv has no {', '.join(sorted(unknown))}")
    return dict.fromkeys(columns) | given
