"""How each method behaves where arithmetic has it hard."""
