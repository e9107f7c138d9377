# What the configuration is going to take on this machine, said before it is paid for. A forecast is
# of the moment: it is made anew whenever it is asked for and never otherwise, so it is no output
# that Snakemake would keep up to date. cost.csv compares what jobs took with the last one there is.
import json


rule:
    name:
        "forecast"
    input:
        code=code("cli.forecast"),
        compiled=sorted(
            {
                compiled(scene, method)
                for scene in SCENES.values()
                for method in METHODS
                if point_files(scene, method)
            }
        ),
    log:
        f"{RESULTS}/logs/forecast.log",
    threads: 64  # all that there are
    params:
        configuration=json.dumps(config, sort_keys=True),
        table=f"{RESULTS}/forecast.csv",
    shell:
        "python -m twodiscs.cli.forecast --configuration {params.configuration:q}"
        " --cores {threads} --output {params.table:q} 2> {log:q}"
